// Writes glTF with EXT_lights_image_based.
#include "domelight/io/file/atomic_file.h"

#include "io/file/json.h"
#include "io/picture/png_memory.h"
#include "scene/gltf/gltf_image_light.h"

#include <fmt/format.h>

#include <bit>
#include <string_view>

namespace domelight {

namespace {

/// RFC 4648, section 4.
std::string base64(std::span<const std::uint8_t> bytes) {
    static constexpr std::string_view k_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (k < count ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? k_digits[three >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

}  // namespace

Result<void> write_gltf_image_light(const std::filesystem::path& file, const GltfImageLightFile& light, int threads) {
    const Texture& cube = light.cube;
    if (cube.encoding != Encoding::rgbd || cube.faces != 6 || !std::has_single_bit(unsigned(cube.width)))
        return Error{"EXT_lights_image_based holds rgbd cubes whose width is a power of two", file.string(), ""};
    const auto pictures = encode_faces(cube, threads);
    if (!pictures) return pictures.error().at(file.string());

    Json images = Json::array(), levels = Json::array(), coefficients = Json::array();
    for (std::size_t i = 0; i < pictures->size(); ++i) {
        images.push_back({{"uri", "data:image/png;base64," + base64((*pictures)[i])}});
        if (i % 6 == 0) levels.push_back(Json::array());
        levels.back().push_back(i);
    }
    for (const Vec3d& v : light.irradiance) coefficients.push_back(Json::array({v.x, v.y, v.z}));
    const Json definition{{"name", light.name},
                          {"intensity", 1},
                          {"rotation", Json::array({0, 0, 0, 1})},
                          {"irradianceCoefficients", coefficients},
                          {"specularImageSize", cube.width},
                          {"specularImages", levels}};
    const Json json{{"asset", {{"version", "2.0"}, {"generator", light.generator}}},
                    {"extensionsUsed", {"EXT_lights_image_based"}},
                    {"extensions", {{"EXT_lights_image_based", {{"lights", Json::array({definition})}}}}},
                    {"images", images},
                    {"scenes", Json::array({{{"extensions", {{"EXT_lights_image_based", {{"light", 0}}}}}}})},
                    {"scene", 0}};
    const std::string text = json.dump(1) + "\n";
    return write_file_atomically(file, text);
}

}  // namespace domelight
