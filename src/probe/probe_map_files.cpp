#include "probe/probe_map_files.h"

#include "texture/texel/encode_row.h"

#include <fmt/core.h>

#include <cstring>

namespace domelight {
namespace {

std::string joined(std::span<const float> values) {
    std::string text;
    for (const float v : values) text += fmt::format("{}{:.6g}", text.empty() ? "" : " ", v);
    return text;
}

/// Encodes RGB texels, and counts those beyond what the encoding can hold.
std::vector<std::uint8_t> encoded(const Cubemap& cube, Encoding encoding, std::int64_t& clipped) {
    const std::span<const float> texels = cube.pixels();
    const float most = float(encoding_max(encoding));
    for (std::size_t i = 0; i < texels.size(); i += 3)
        clipped += texels[i] > most || texels[i + 1] > most || texels[i + 2] > most;
    const Texture texture = encode_texture(std::array{FilteredMap(cube)}, encoding, 1);
    return {texture.levels[0].begin(), texture.levels[0].end()};
}

}  // namespace

Result<ProbeMapWriter> ProbeMapWriter::open(const ProbeMapFilePaths& paths, int probes, const ProbeMapSizes& sizes,
                                            std::span<const float> roughness, Encoding encoding) {
    auto specular = CubeArrayWriter::open(
        paths.specular, {encoding,
                         sizes.specular[0],
                         int(sizes.specular.size()),
                         probes,
                         {{"domelight.quantity", "radiance"}, {"domelight.roughness", joined(roughness)}}});
    if (!specular) return specular.error();
    auto irradiance = CubeArrayWriter::open(
        paths.irradiance, {encoding, sizes.irradiance, 1, probes, {{"domelight.quantity", "irradiance_over_pi"}}});
    if (!irradiance) return irradiance.error();
    std::optional<CubeArrayWriter> distance;
    if (sizes.distance > 0) {
        auto opened = CubeArrayWriter::open(
            paths.distance,
            {Encoding::rg32f, sizes.distance, 1, probes, {{"domelight.quantity", "distance, and its square"}}});
        if (!opened) return opened.error();
        distance.emplace(*std::move(opened));
    }
    return ProbeMapWriter(encoding, *std::move(specular), *std::move(irradiance), std::move(distance));
}

std::int64_t ProbeMapWriter::write(int probe, const ProbeMaps& maps) {
    std::int64_t clipped = 0;
    for (std::size_t l = 0; l < maps.specular.size(); ++l)
        specular_.write(probe, int(l), encoded(maps.specular[l], encoding_, clipped));
    irradiance_.write(probe, 0, encoded(maps.irradiance_over_pi, encoding_, clipped));
    if (distance_) {
        // Two floats a texel, as they lie in memory.
        const auto pixels = maps.distance.pixels();
        distance_->write(probe, 0, {reinterpret_cast<const std::uint8_t*>(pixels.data()), pixels.size_bytes()});
    }
    return clipped;
}

Result<void> ProbeMapWriter::finish() {
    for (CubeArrayWriter* file : {&specular_, &irradiance_, distance_ ? &*distance_ : nullptr})
        if (file)
            if (auto ok = file->finish(); !ok) return ok;
    return {};
}

}  // namespace domelight
