// Writes Babylon's .env, version 2.
#include "domelight/io/file/atomic_file.h"

#include "io/file/json.h"
#include "io/file/output_file.h"
#include "io/picture/png_memory.h"
#include "texture/container/env.h"

#include <fmt/format.h>

#include <bit>
#include <utility>
#include <vector>

namespace domelight {

namespace {

Result<void> check_cube(const Texture& cube) {
    if (cube.encoding != Encoding::rgbd) return Error{"a .env file holds rgbd, not " + name_of(cube.encoding), "", ""};
    if (cube.faces != 6 || cube.width != cube.height || !std::has_single_bit(unsigned(cube.width)) ||
        cube.width > k_max_env_width)
        return Error{
            fmt::format("a .env file holds a cube whose width is a power of two, not {} x {}", cube.width, cube.height),
            "", ""};
    const int levels = std::bit_width(unsigned(cube.width));
    if (int(cube.levels.size()) != levels)
        return Error{fmt::format("a .env file {} wide has {} levels, down to one texel, not {}", cube.width, levels,
                                 cube.levels.size()),
                     "", "Leave the number of levels to the engine."};
    return {};
}

Json vector_json(const Vec3d& v) {
    return Json::array({v.x, v.y, v.z});
}

std::string header_json(const BabylonEnv& env, const std::vector<PngBytes>& pictures) {
    Json mipmaps = Json::array();
    std::uint64_t position = 0;
    for (const PngBytes& picture : pictures) {
        mipmaps.push_back({{"length", picture.size()}, {"position", position}});
        position += picture.size();
    }
    Json json{{"version", 2}, {"width", env.cube.width}, {"imageType", "image/png"}};
    if (env.irradiance) {
        const QuadraticPolynomial& p = *env.irradiance;
        json["irradiance"] = {{"x", vector_json(p.x)},   {"y", vector_json(p.y)},   {"z", vector_json(p.z)},
                              {"xx", vector_json(p.xx)}, {"yy", vector_json(p.yy)}, {"zz", vector_json(p.zz)},
                              {"yz", vector_json(p.yz)}, {"zx", vector_json(p.zx)}, {"xy", vector_json(p.xy)}};
    }
    json["specular"] = {{"mipmaps", mipmaps}, {"lodGenerationScale", env.lod_scale}};
    return json.dump();
}

}  // namespace

QuadraticPolynomial babylon_polynomial(std::span<const Vec3d> radiance) {
    QuadraticPolynomial p = sh_polynomial(
        sh_irradiance_over_pi(sh_irradiance_over_pi(radiance.first(std::min<std::size_t>(9, radiance.size())))));
    p.x = -p.x, p.zx = -p.zx, p.xy = -p.xy;  // its world: x the other way
    return p;
}

namespace {

/// The pictures of an environment, and the text in front of them, which ends in a zero.
struct StoredEnv {
    std::string json;
    std::vector<PngBytes> pictures;
};

Result<StoredEnv> stored_env(const BabylonEnv& env, int threads) {
    if (const auto fits = check_cube(env.cube); !fits) return fits.error();
    Texture cube = env.cube;
    flip_faces(cube);
    auto pictures = encode_faces(cube, threads);
    if (!pictures) return pictures.error();
    std::string json = header_json(env, *pictures) + '\0';
    return StoredEnv{std::move(json), *std::move(pictures)};
}

}  // namespace

Result<void> write_env(const std::filesystem::path& file, const BabylonEnv& env, int threads) {
    const auto stored = stored_env(env, threads);
    if (!stored) return stored.error().at(file.string());
    return write_file_atomically(file, [&](const std::filesystem::path& path) {
        OutputFile out(path);
        out.write(std::span<const std::uint8_t>(k_env_magic));
        out.write(std::span<const char>(stored->json));
        for (const PngBytes& picture : stored->pictures) out.write(picture);
        return out.finish();
    });
}

Result<TexelBytes> env_bytes(const BabylonEnv& env, int threads) {
    const auto stored = stored_env(env, threads);
    if (!stored) return stored.error();
    TexelBytes file;
    file.insert(file.end(), k_env_magic.begin(), k_env_magic.end());
    file.insert(file.end(), stored->json.begin(), stored->json.end());
    for (const PngBytes& picture : stored->pictures) file.insert(file.end(), picture.begin(), picture.end());
    return file;
}

}  // namespace domelight
