#include "scene/mesh/mtl_reader.h"

#include "io/file/path_inside.h"
#include "io/file/printable.h"
#include "io/file/text_fields.h"
#include "io/image_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace domelight {

namespace {

Vec3f colour(std::string_view rest, float high = 1) {
    float c[3] = {0, 0, 0};
    for (int i = 0; i < 3; ++i) {
        double value = 0;
        // One number stands for three.
        c[i] = parse_number(take_word(rest), value) && value >= 0 ? std::min(float_of(value), high) : i ? c[0] : 0;
    }
    return {c[0], c[1], c[2]};
}

float number(std::string_view rest, float fallback, float low, float high) {
    double value = 0;
    return parse_number(take_word(rest), value) && !std::isnan(value) ? std::clamp(float_of(value), low, high)
                                                                      : fallback;
}

class MtlReader {
  public:
    MtlReader(const std::filesystem::path& folder, const std::filesystem::path& root, Scene& scene,
              std::vector<SceneImageSource>& sources)
        : folder_(folder), root_(root), scene_(scene), sources_(sources) {}
    void read(std::string_view text, std::map<std::string, int, std::less<>>& numbers);

  private:
    void statement(std::string_view key, std::string_view rest, Material& m);
    SceneTexture texture(std::string_view rest);

    const std::filesystem::path &folder_, root_;
    Scene& scene_;
    std::vector<SceneImageSource>& sources_;
    std::set<std::string> left_out_;
};

/// "-option value... name": options are left out, the rest of the line is the name.
SceneTexture MtlReader::texture(std::string_view rest) {
    for (rest = trimmed(rest); rest.starts_with('-');) {
        left_out_.insert(std::string(take_word(rest)));
        for (rest = trimmed(rest);; rest = trimmed(rest)) {
            std::string_view after = rest;
            double value = 0;
            const std::string_view word = take_word(after);
            if (after.empty() || !(parse_number(word, value) || word == "on" || word == "off")) break;
            rest = after;
        }
    }
    std::string name(rest);
    std::replace(name.begin(), name.end(), '\\', '/');
    SceneTexture texture;
    const auto known =
        std::find_if(sources_.begin(), sources_.end(), [&](const SceneImageSource& s) { return s.name == name; });
    texture.image = int(known - sources_.begin());
    if (known == sources_.end())
        sources_.push_back(
            {name, [name, folder = folder_, root = root_]() -> Result<std::shared_ptr<const FileBytes>> {
                 const auto path = path_inside(folder / name, root, name);
                 if (!path) return path.error();
                 auto file = FileBytes::open(*path, std::int64_t(1) << 30, FileKinds::regular);
                 return file ? file : Error{printable(name, 80) + ": " + file.error().what, "", file.error().hint};
             }});
    return texture;
}

void MtlReader::statement(std::string_view key, std::string_view rest, Material& m) {
    if (key == "Kd") {
        m.base_color = colour(rest);
    } else if (key == "Ks") {
        m.specular_color = colour(rest) * 2;  // times 0.04 for an index of refraction of 1.5
    } else if (key == "Ke") {
        m.emission = colour(rest, 1e9f);
    } else if (key == "Ns") {
        m.roughness = std::pow(2 / (number(rest, 0, 0, 1e6f) + 2), 0.25f);
    } else if (key == "Ni") {
        m.ior = number(rest, 1.5f, 1, 10);
        if (m.ior == 1) m.ior = 1.5f;  // what exporters write for "not said"
    } else if (key == "d" || key == "Tr") {
        const float d = number(rest, key == "d" ? 1.0f : 0.0f, 0, 1);
        m.opacity = key == "d" ? d : 1 - d;
        if (m.opacity < 1) m.alpha_mode = Material::AlphaMode::blend;
    } else if (key == "Pr") {
        m.roughness = number(rest, 0.5f, 0, 1);
    } else if (key == "Pm") {
        m.metalness = number(rest, 0, 0, 1);
    } else if (key == "map_Kd") {
        m.base_color_texture = texture(rest);
    } else if (key == "map_Ke") {
        m.emission_texture = texture(rest);
    } else if (key == "norm") {
        m.normal_texture = texture(rest);
    } else if (key.starts_with("map_") || key == "bump" || key == "disp" || key == "refl") {
        left_out_.insert(printable(key));
    }
}

void MtlReader::read(std::string_view text, std::map<std::string, int, std::less<>>& numbers) {
    int current = -1;
    TextLines lines(text);
    for (std::string_view line; lines.next(line);) {
        const std::string_view key = take_word(line);
        if (key == "newmtl") {
            current = int(scene_.materials.size());
            scene_.materials.push_back(plain_material());
            scene_.materials.back().name = std::string(trimmed(line));
            numbers[scene_.materials.back().name] = current;
        } else if (current >= 0 && !key.empty() && key[0] != '#') {
            statement(key, line, scene_.materials[std::size_t(current)]);
        }
    }
    for (const std::string& what : left_out_) scene_.warnings.push_back(fmt::format("materials: {} is not read", what));
}

}  // namespace

Material plain_material() {
    Material m;
    m.name = "default";
    m.base_color = {0.8f, 0.8f, 0.8f};
    m.metalness = 0;
    m.roughness = 0.5f;
    m.double_sided = true;
    return m;
}

void read_mtl(std::string_view text, const std::filesystem::path& folder, const std::filesystem::path& root,
              Scene& scene, std::map<std::string, int, std::less<>>& numbers, std::vector<SceneImageSource>& sources) {
    MtlReader(folder, root, scene, sources).read(text, numbers);
}

}  // namespace domelight
