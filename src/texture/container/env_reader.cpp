// Reads Babylon's .env.
#include "io/file/json_fields.h"
#include "io/picture/texture_image.h"
#include "texture/container/env.h"
#include "texture/container/texture_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

namespace domelight {

namespace {

/// A picture's place in the file.
struct Place {
    std::uint64_t offset = 0, length = 0;
};

/// The contents of the JSON, checked against the file.
struct Header {
    int version = 1, width = 0, levels = 0;
    std::vector<Place> pictures;  ///< level by level, +X -X +Y -Y +Z -Z
    std::optional<QuadraticPolynomial> irradiance;
    double lod_scale = 0.8;
};

/// The text of the JSON; `end` is set to the offset of the pictures.
Result<std::string> header_text(ByteSource& source, std::uint64_t& end) {
    const std::uint64_t start = k_env_magic.size();
    const auto magic = source.take(0, start, "identifier");
    if (!magic) return magic.error();
    if (!std::equal(k_env_magic.begin(), k_env_magic.end(), magic->begin()))
        return Error{"is not a Babylon .env file", "", ""};
    const auto bytes = source.take(start, std::min(source.size() - start, k_max_env_json), "header");
    if (!bytes) return bytes.error();
    const auto zero = std::find(bytes->begin(), bytes->end(), std::uint8_t(0));
    if (zero == bytes->end())
        return Error{"its header does not end", "", "The file is truncated, or is not a Babylon .env file."};
    end = start + std::uint64_t(zero - bytes->begin()) + 1;
    return std::string(bytes->begin(), zero);
}

Vec3d vector_of(JsonFields& fields, const char* key) {
    const auto v = fields.require(key).numbers(key, 3);
    return v.size() == 3 ? Vec3d{v[0], v[1], v[2]} : Vec3d{};
}

std::optional<QuadraticPolynomial> read_irradiance(JsonFields fields) {
    if (!fields || !fields.has("xx")) return std::nullopt;
    QuadraticPolynomial p;
    const std::pair<const char*, Vec3d*> members[] = {{"x", &p.x},   {"y", &p.y},   {"z", &p.z},
                                                      {"xx", &p.xx}, {"yy", &p.yy}, {"zz", &p.zz},
                                                      {"yz", &p.yz}, {"zx", &p.zx}, {"xy", &p.xy}};
    for (const auto& [key, value] : members) *value = vector_of(fields, key);
    return p;
}

Result<Header> read_header(ByteSource& source) {
    std::uint64_t data = 0;
    const auto text = header_text(source, data);
    if (!text) return text.error();
    const auto json = parse_json(*text);
    if (!json) return json.error();

    std::optional<Error> error;
    JsonFields root(*json, "", error);
    Header header;
    const std::uint64_t version = root.require("version").size("version", 0),
                        width = root.require("width").size("width", 0);
    if (version < 1 || version > 2)
        root.fail("version", fmt::format("is {}, but only versions 1 and 2 are known", version));
    if (width < 1 || width > std::uint64_t(k_max_env_width) || !std::has_single_bit(width))
        root.fail("width", fmt::format("{} is not a power of two up to {}", width, k_max_env_width));
    JsonFields specular = root.require("specular").object("specular");
    header.lod_scale = specular.number("lodGenerationScale", 0.8f);
    auto pictures = specular.require("mipmaps").array("mipmaps");
    const std::size_t most = 6 * std::size_t(std::bit_width(width));
    if (pictures.empty() || pictures.size() % 6 || pictures.size() > most)
        specular.fail("mipmaps", fmt::format("{} pictures, but a cube {} wide has 6 for each of up to {} levels",
                                             pictures.size(), width, most / 6));
    for (JsonFields& picture : pictures) {
        const Place place{picture.require("position").size("position", 0), picture.require("length").size("length", 0)};
        if (!source.contains(data, place.offset) || !source.contains(data + place.offset, place.length))
            picture.fail("position", fmt::format("{} bytes at {} lie past the file's end", place.length, place.offset));
        header.pictures.push_back({data + place.offset, place.length});
    }
    header.irradiance = read_irradiance(root.object("irradiance"));
    if (error) return Error{error->what, "", "The file is damaged."};
    header.version = int(version), header.width = int(width), header.levels = int(pictures.size() / 6);
    return header;
}

/// The texels of a face. No memory is allocated for a picture that states a different size, or a larger one than its
/// bytes can hold.
Result<Rgba8Image> read_face(ByteSource& source, const Place& place, int size) {
    const auto bytes = source.take(place.offset, place.length, "picture");
    if (!bytes) return bytes.error();
    const auto claimed = texture_image_size(*bytes);
    if (!claimed) return claimed.error();
    if (claimed->width != size || claimed->height != size)
        return Error{
            fmt::format("a picture of {} x {} where {} x {} belongs", claimed->width, claimed->height, size, size), "",
            "The file is damaged."};
    return decode_texture_image(*bytes);
}

/// All faces of a level, one after the other.
Result<TexelBytes> read_level(ByteSource& source, std::span<const Place> faces, int size) {
    TexelBytes texels;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto face = read_face(source, faces[f], size);
        if (!face) return Error{fmt::format("face {}: {}", f, face.error().what), "", face.error().hint};
        if (texels.empty()) texels.resize(face->rgba.size() * faces.size());
        std::copy(face->rgba.begin(), face->rgba.end(), texels.begin() + std::ptrdiff_t(face->rgba.size() * f));
    }
    return texels;
}

}  // namespace

void flip_faces(Texture& cube) {
    for (std::size_t l = 0; l < cube.levels.size(); ++l) {
        const std::size_t height = std::size_t(cube.level_height(int(l))), row = cube.face_bytes(int(l)) / height;
        for (std::size_t face = 0; face < std::size_t(cube.faces); ++face) {
            std::uint8_t* first = cube.levels[l].data() + face * row * height;
            for (std::size_t y = 0; y < height / 2; ++y)
                std::swap_ranges(first + y * row, first + (y + 1) * row, first + (height - 1 - y) * row);
        }
    }
}

Result<TextureInfo> env_info(ByteSource& source) {
    const auto header = read_header(source);
    if (!header) return header.error();
    TextureInfo info;
    info.container = fmt::format("Babylon .env version {}", header->version);
    info.format = "RGBD pictures";
    info.supercompression = "none";
    info.width = info.height = header->width;
    info.faces = 6;
    info.levels = header->levels;
    info.decodable = true;
    return info;
}

Result<BabylonEnv> env_file(ByteSource& source) {
    const auto header = read_header(source);
    if (!header) return header.error();
    BabylonEnv env;
    env.irradiance = header->irradiance;
    env.lod_scale = header->lod_scale;
    env.cube.encoding = Encoding::rgbd;
    env.cube.width = env.cube.height = header->width;
    env.cube.faces = 6;
    for (int l = 0; l < header->levels; ++l) {
        auto level =
            read_level(source, std::span(header->pictures).subspan(6 * std::size_t(l), 6), env.cube.level_width(l));
        if (!level) return Error{fmt::format("level {}: {}", l, level.error().what), "", level.error().hint};
        env.cube.levels.push_back(std::move(*level));
    }
    flip_faces(env.cube);
    return env;
}

Result<BabylonEnv> read_env(const std::filesystem::path& file) {
    Result<FileSource> source = FileSource::open(file);
    if (!source) return source.error();
    auto env = env_file(*source);
    if (!env) return env.error().at(file.string());
    return env;
}

}  // namespace domelight
