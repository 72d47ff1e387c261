#include "domelight/base/version.h"
#include "domelight/engines/engine.h"
#include "domelight/io/file/atomic_file.h"

#include "base/field_place.h"
#include "capture/engine_files/engine_writers.h"

#include <fmt/core.h>

namespace domelight {

Result<ProbeGrid> grid_for(const EngineFilesJob& job) {
    if (const auto& grid = job.set.grid()) return *grid;
    return Error{fmt::format("{} interpolates in a grid, and the probes of this set are not in one", job.engine),
                 field_place("engine"), "Place them with `grid` or `density`."};
}

GridVolume volume_of(const ProbeGrid& grid) {
    const Vec3f size{float(grid.nx) * grid.spacing.x, float(grid.ny) * grid.spacing.y, float(grid.nz) * grid.spacing.z};
    return {grid.origin + (size - grid.spacing) * 0.5f, size};
}

Result<void> write_grid_files(EngineFilesJob& job, const std::string& name, const VolumeTexels& volume,
                              Encoding encoding, Json json) {
    auto staging = Staging::open(job.folder, job.options.inputs);
    if (!staging) return staging.error();
    const std::string texture = name + ".ktx2", description = name + ".json";
    const auto clipped = write_volume(staging->stage(texture), volume, encoding);
    if (!clipped) return clipped.error().at((job.folder / texture).string());
    job.report.clipped_texels += *clipped;
    json["generator"] = fmt::format("domelight {}", version());
    json["texture"] = texture;
    const std::string text = json.dump(1) + "\n";
    if (auto written = write_file_atomically(staging->stage(description), text); !written) return written.error();
    job.report.files = {texture, description};
    return staging->commit(description);
}

Result<EngineFilesReport> write_engine_files(const ProbeSet& set, const std::string& engine,
                                             const std::filesystem::path& folder, const EngineFilesOptions& options) {
    if (auto known = find_engine(engine); !known) return known.error();
    EngineFilesJob job{set, engine, folder, options, {}};
    const auto written = engine == "three"  ? write_light_probe_grid(job)
                         : engine == "bevy" ? write_irradiance_volume(job)
                                            : write_reflection_probes(job);
    if (!written) return written.error();
    return std::move(job.report);
}

}  // namespace domelight
