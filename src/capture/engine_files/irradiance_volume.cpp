// Bevy's IrradianceVolume, as its shader irradiance_volume.wgsl reads it: an ambient cube of E / pi at each place, in a 3D
// texture of nx × 2 ny × 3 nz texels. Along z there are three blocks, for X, Y and Z; along y two, first the positive
// and then the negative side. (Its documentation has the two sides the other way round.)

#include "capture/engine_files/engine_writers.h"

namespace domelight {

Result<void> write_irradiance_volume(EngineFilesJob& job) {
    const auto grid = grid_for(job);
    if (!grid) return grid.error();
    VolumeTexels texture(grid->nx, 2 * grid->ny, 3 * grid->nz);
    for (int z = 0; z < grid->nz; ++z)
        for (int y = 0; y < grid->ny; ++y)
            for (int x = 0; x < grid->nx; ++x) {
                const AmbientCube cube = fit_ambient_cube(job.set, grid->index(x, y, z));
                for (int side = 0; side < 6; ++side) {
                    const Vec3f& v = cube[std::size_t(side)];
                    texture.at(x, y + (side < 3 ? 0 : grid->ny), z + side % 3 * grid->nz) = {v.x, v.y, v.z, 0};
                }
            }
    const GridVolume volume = volume_of(*grid);
    return write_grid_files(job, "irradiance-volume", texture, Encoding::rgb9e5,
                            {{"translation", vector_json(volume.centre)},
                             {"scale", vector_json(volume.size)},
                             {"resolution", {grid->nx, grid->ny, grid->nz}}});
}

}  // namespace domelight
