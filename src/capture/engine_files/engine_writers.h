#pragma once

#include "domelight/capture/engine_files.h"

#include "bake/staging.h"
#include "capture/engine_files/volume_texture.h"
#include "io/file/json.h"
#include "probe/probe_record.h"

namespace domelight {

/// What a writer needs: the set, where files go, and what to report.
struct EngineFilesJob {
    const ProbeSet& set;
    const std::string& engine;
    const std::filesystem::path& folder;
    const EngineFilesOptions& options;
    EngineFilesReport report;
};

// Each writes the files of one kind (engine_files.h).
Result<void> write_light_probe_grid(EngineFilesJob& job);
Result<void> write_irradiance_volume(EngineFilesJob& job);
Result<void> write_reflection_probes(EngineFilesJob& job);

/// The set's grid. Errors: it has none; the engine is named.
Result<ProbeGrid> grid_for(const EngineFilesJob& job);

/// The box whose cells have the grid's places at their centres.
struct GridVolume {
    Vec3f centre, size;  ///< metres
};
GridVolume volume_of(const ProbeGrid& grid);

/// Writes one volume texture, and a file NAME.json that holds `json` and names it; both appear together.
Result<void> write_grid_files(EngineFilesJob& job, const std::string& name, const VolumeTexels& volume,
                              Encoding encoding, Json json);

}  // namespace domelight
