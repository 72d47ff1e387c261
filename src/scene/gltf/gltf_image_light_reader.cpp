// Reads glTF's EXT_lights_image_based.
#include "io/file/json.h"
#include "io/file/json_fields.h"
#include "io/picture/screen_colour.h"
#include "io/picture/texture_image.h"
#include "scene/gltf/gltf_chunks.h"
#include "scene/gltf/gltf_data.h"
#include "scene/gltf/gltf_image_light.h"
#include "texture/texel/rgba8_ranges.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

namespace domelight {

namespace {

constexpr const char* k_extension = "EXT_lights_image_based";
constexpr std::uint64_t k_max_size = 1 << 14;

/// The definition of a light, checked but for its pictures.
struct Definition {
    double intensity = 1;
    std::array<float, 4> rotation{0, 0, 0, 1};
    std::vector<Vec3d> irradiance;
    int size = 0;
    std::vector<std::array<int, 6>> levels;  ///< indices of images
};

/// An array of arrays of numbers; anything else is noted in `fields` and gives none.
std::vector<std::vector<double>> numbers_of(JsonFields& fields, const Json& light, const char* key, std::size_t inner) {
    std::vector<std::vector<double>> rows;
    fields.require(key);
    const Json* at = light.find(key);
    if (!at || !at->is_array()) {
        fields.fail(key, "is not an array");
        return {};
    }
    for (const Json& row : at->elements()) {
        const bool fits =
            row.is_array() && row.size() == inner && std::ranges::all_of(row.elements(), &Json::is_number);
        if (!fits) {
            fields.fail(key, fmt::format("its elements are not {} numbers each", inner));
            return {};
        }
        rows.emplace_back();
        for (const Json& v : row.elements()) rows.back().push_back(v.get<double>());
    }
    return rows;
}

/// The light that the scene names, else the first.
Result<Definition> definition_of(const Json& json, std::size_t images) {
    std::optional<Error> error;
    JsonFields root(json, "", error);
    auto lights = root.extension(k_extension).array("lights");
    if (lights.empty()) return error ? *error : Error{"has no light from all around", "", ""};
    int index = 0;
    auto scenes = root.array("scenes");
    const int scene = std::max(0, root.index("scene", std::max<std::size_t>(1, scenes.size())));
    if (std::size_t(scene) < scenes.size())
        index = std::max(0, scenes[std::size_t(scene)].extension(k_extension).index("light", lights.size()));
    if (error) return *error;

    Definition d;
    JsonFields& fields = lights[std::size_t(index)];
    const Json& light = json["extensions"][k_extension]["lights"][std::size_t(index)];
    d.intensity = fields.number("intensity", 1, 0, 1e20f);
    if (const auto rotation = fields.numbers("rotation", 4); rotation.size() == 4)
        std::copy(rotation.begin(), rotation.end(), d.rotation.begin());
    for (const auto& v : numbers_of(fields, light, "irradianceCoefficients", 3))
        d.irradiance.push_back({v[0], v[1], v[2]});
    if (!error && d.irradiance.size() != 9)
        fields.fail("irradianceCoefficients", fmt::format("{} of them, not 9", d.irradiance.size()));
    const std::uint64_t size = fields.require("specularImageSize").size("specularImageSize", 0);
    if (size < 1 || size > k_max_size || !std::has_single_bit(size))
        fields.fail("specularImageSize", fmt::format("{} is not a power of two up to {}", size, k_max_size));
    for (const auto& faces : numbers_of(fields, light, "specularImages", 6)) {
        std::array<int, 6>& level = d.levels.emplace_back();
        for (std::size_t f = 0; f < 6; ++f) {
            const bool there = faces[f] >= 0 && faces[f] < double(images) && faces[f] == std::floor(faces[f]);
            if (!there) fields.fail("specularImages", fmt::format("there is no image {}", faces[f]));
            level[f] = there ? int(faces[f]) : 0;
        }
    }
    if (!error && (d.levels.empty() || d.levels.size() > std::size_t(std::bit_width(size))))
        fields.fail("specularImages", fmt::format("{} levels, but a cube {} wide has from 1 to {}", d.levels.size(),
                                                  size, std::bit_width(size)));
    if (error) return *error;
    d.size = int(size);
    return d;
}

/// A PNG with a fourth channel is RGBD; everything else is sRGB.
bool has_fourth_channel(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t k_colour_type = 25;  // PNG specification, section 11.2.1; bit 2 says alpha
    return bytes.size() > k_colour_type && bytes[0] == 0x89 && (bytes[k_colour_type] & 4);
}

Result<void> decode_face(std::span<const std::uint8_t> bytes, ImageView<float> face, bool& low_dynamic_range) {
    const auto size = texture_image_size(bytes);
    if (!size) return size.error();
    if (size->width != face.width || size->height != face.height)
        return Error{fmt::format("a picture of {} x {} where {} x {} belongs", size->width, size->height, face.width,
                                 face.height),
                     "", ""};
    const auto image = decode_texture_image(bytes);
    if (!image) return image.error();
    const bool rgbd = has_fourth_channel(bytes);
    low_dynamic_range = low_dynamic_range || !rgbd;
    const std::vector<float> linear = screen_curve(Decode::srgb, 256);
    const std::uint8_t* p = image->rgba.data();
    for (int y = 0; y < face.height; ++y)
        for (int x = 0; x < face.width; ++x, p += 4) {
            const Vec3f v =
                rgbd ? rgb_from_rgbd({p[0], p[1], p[2], p[3]}) : Vec3f{linear[p[0]], linear[p[1]], linear[p[2]]};
            float* out = face.at(x, y);
            out[0] = v.x, out[1] = v.y, out[2] = v.z;
        }
    return {};
}

}  // namespace

bool may_be_gltf_image_light(std::span<const std::uint8_t> bytes) {
    constexpr std::string_view k_white = " \t\r\n";
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t first = text.find_first_not_of(k_white);
    const bool gltf = text.starts_with("glTF") || (first < 64 && text[first] == '{');
    return gltf && text.find(k_extension) != text.npos;
}

Result<GltfImageLight> read_gltf_image_light(std::shared_ptr<const FileBytes> bytes,
                                             const std::optional<std::filesystem::path>& folder, std::int64_t max_bytes,
                                             int most_levels) {
    const auto chunks = split_gltf(bytes->bytes());
    if (!chunks) return chunks.error();
    const auto document = parse_gltf_document(chunks->json, {});
    if (!document) return document.error();
    const auto json = parse_json(chunks->json);
    if (!json) return json.error();
    const auto definition = definition_of(*json, document->images.size());
    if (!definition) return definition.error();
    ByteBudget budget(max_bytes);
    auto data = GltfData::open(*document, chunks->binary, folder, budget);
    if (!data) return data.error();

    GltfImageLight light;
    light.intensity = definition->intensity;
    light.rotation = definition->rotation;
    light.irradiance = definition->irradiance;
    for (std::size_t l = 0; l < definition->levels.size() && l < std::size_t(std::max(1, most_levels)); ++l) {
        const int size = std::max(1, definition->size >> l);
        const auto at = [&](int f, const Error& e) {
            return Error{fmt::format("level {}, face {}: {}", l, f, e.what), "", e.hint};
        };
        for (int f = 0; f < 6; ++f) {
            const GltfImage& image = document->images[std::size_t(definition->levels[l][std::size_t(f)])];
            std::shared_ptr<const FileBytes> held;
            std::span<const std::uint8_t> picture;
            if (image.view >= 0) {
                const auto view = data->view(image.view);
                if (!view) return at(f, view.error());
                picture = *view;
            } else {
                auto resource = data->resource(image.uri);
                if (!resource) return at(f, resource.error());
                held = *resource;
                picture = held->bytes();
            }
            if (f == 0) {
                // Allocates the cube once the size of its first picture is known and right.
                const auto claimed = texture_image_size(picture);
                if (!claimed) return at(f, claimed.error());
                if (claimed->width != size || claimed->height != size)
                    return at(f, {fmt::format("a picture of {} x {} where {} x {} belongs", claimed->width,
                                              claimed->height, size, size),
                                  "", ""});
                if (auto room = budget.take(std::uint64_t(size) * std::uint64_t(size), 6 * 3 * sizeof(float), "a cube");
                    !room)
                    return at(f, room.error());
                light.levels.emplace_back(size);
            }
            if (auto ok = decode_face(picture, light.levels.back().face(f), light.low_dynamic_range); !ok)
                return at(f, ok.error());
        }
    }
    return light;
}

}  // namespace domelight
