#include "io/environment/cube_texture_reader.h"

#include "domelight/texture/texture.h"

#include "image/repair.h"
#include "scene/gltf/gltf_image_light.h"
#include "texture/block/astc_codec.h"
#include "texture/container/texture_reading.h"
#include "texture/texel_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace domelight {

std::string texture_container(std::span<const std::uint8_t> bytes) {
    using namespace std::string_view_literals;
    const std::string_view start(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 16));
    if (start.starts_with("\xabKTX 20\xbb\r\n\x1a\n"sv)) return "KTX2";
    if (start.starts_with("\xabKTX 11\xbb\r\n\x1a\n"sv)) return "KTX";
    if (start.starts_with("DDS "sv)) return "DDS";
    if (start.starts_with("\x86\x16\x87\x96\xf6\xd6\x96\x36"sv)) return "Babylon .env";
    return "";
}

namespace {

/// What was taken for the curve of eight bits a channel, where nobody said it.
std::string assumed_curve(const TextureInfo& info) {
    if (info.container == "DDS") return "; the curve is taken to be sRGB";
    const bool srgb = info.format.find("SRGB") != std::string::npos;
    return fmt::format("; the curve is {}, as the format {} states", srgb ? "sRGB" : "linear", info.format);
}

}  // namespace

Result<Cubemap> read_cube_texture(std::span<const std::uint8_t> bytes, std::int64_t max_bytes, RepairOptions repair,
                                  RepairReport& report, Decode decode) {
    MemorySource source(bytes);
    const Result<TextureInfo> info = texture_info(source);
    if (!info) return info.error();
    if (info->faces != 6 || info->width != info->height || info->layers > 1)
        return Error{"texture is not a cube", "", "An environment must be a cube or a lat-long image."};
    // The decoded faces are in memory together with the encoded texture.
    const std::int64_t size = info->width;
    if (size < 1 || size > 65536 || 2 * 6 * size * size * 12 > max_bytes)
        return Error{
            fmt::format("a cube of {} x {} faces needs more memory than the limit of {} bytes", size, size, max_bytes),
            "", ""};
    const Result<Texture> texture = domelight::texture(source, decode);
    if (!texture) return texture.error();
    const bool astc = texture->encoding == Encoding::astc4x4_hdr || texture->encoding == Encoding::astc6x6_hdr;
    if (astc && !has_astc_codec()) return Error{"ASTC is not read by this build", "", "Convert it to BC6H or floats."};
    if (encoding_channels(texture->encoding) != 3)
        return Error{"the texture has fewer than three channels, not a colour", "",
                     "Save it with red, green and blue."};

    Cubemap cube(texture->width);
    if (texture->encoding == Encoding::rgba16f || texture->encoding == Encoding::r11g11b10f) repair.largest = 65504;
    for (int f = 0; f < 6; ++f) {
        const ImageF face = decode_texture(*texture, 0, f);
        for (int y = 0; y < cube.size(); ++y)
            for (int x = 0; x < cube.size(); ++x) std::copy_n(face.at(x, y), 3, cube.face(f).at(x, y));
        repair_image(cube.face(f), repair, report);
    }
    if (info->container.starts_with("Babylon")) {
        const TexelOrder mirrored = TexelOrder::of_cube({{Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}});
        return mirrored.apply(std::move(cube)).cube();
    }
    if (info->eight_bits && texture->encoding == Encoding::rgba16f)
        report.warnings.push_back(std::string("eight bits a channel are not HDR unless they are RGBM or its like "
                                              "(`decode` rgbm)") +
                                  (decode != Decode::automatic ? "" : assumed_curve(*info)));
    return cube;
}

Result<GltfEnvironment> read_gltf_environment(std::shared_ptr<const FileBytes> bytes,
                                              const std::optional<std::filesystem::path>& folder,
                                              std::int64_t max_bytes, RepairOptions repair, RepairReport& report) {
    auto light = read_gltf_image_light(std::move(bytes), folder, max_bytes, 1);
    if (!light) return light.error();
    GltfEnvironment environment{std::move(light->levels.front()), light->rotation};
    repair.scale *= float(light->intensity);
    for (int f = 0; f < 6; ++f) repair_image(environment.cube.face(f), repair, report);
    if (light->low_dynamic_range)
        report.warnings.push_back("the light's pictures are not HDR: values above 1 are clipped");
    return environment;
}

}  // namespace domelight
