// three.js' LightProbeGrid (its shader chunk lightprobes_pars_fragment): nine harmonics of the radiance in one 3D texture
// of RGBA texels. The 27 numbers of a place fill the channels of seven texels in order, and the last channel is 0. Each
// of the seven has a volume of nz + 2 slices, the first and last of which repeat the next, so that a lookup between
// texels does not reach into another volume.

#include "capture/engine_files/engine_writers.h"

#include <algorithm>

namespace domelight {
namespace {

/// The 28 channels of a place. three's basis is sh_basis(), with constants of six digits.
std::array<float, 28> channels_of(std::span<const Vec3d, 9> harmonics) {
    std::array<float, 28> channels{};
    for (std::size_t i = 0; i < 9; ++i) {
        channels[3 * i] = float(harmonics[i].x);
        channels[3 * i + 1] = float(harmonics[i].y);
        channels[3 * i + 2] = float(harmonics[i].z);
    }
    return channels;
}

}  // namespace

Result<void> write_light_probe_grid(EngineFilesJob& job) {
    const auto grid = grid_for(job);
    if (!grid) return grid.error();
    const int slices = grid->nz + 2;
    VolumeTexels atlas(grid->nx, grid->ny, 7 * slices);
    for (int z = -1; z <= grid->nz; ++z)
        for (int y = 0; y < grid->ny; ++y)
            for (int x = 0; x < grid->nx; ++x) {
                const int place = grid->index(x, y, std::clamp(z, 0, grid->nz - 1));
                const auto c = channels_of(job.set.harmonics(place));
                for (int t = 0; t < 7; ++t) {
                    const float* v = c.data() + 4 * t;
                    atlas.at(x, y, t * slices + z + 1) = {v[0], v[1], v[2], v[3]};
                }
            }
    const GridVolume volume = volume_of(*grid);
    return write_grid_files(job, "light-probe-grid", atlas, Encoding::rgba16f,
                            {{"position", vector_json(volume.centre)},
                             {"size", vector_json(volume.size)},
                             {"resolution", {grid->nx, grid->ny, grid->nz}}});
}

}  // namespace domelight
