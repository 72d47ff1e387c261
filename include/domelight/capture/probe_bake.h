#pragma once
// A set of probes from a scene: captured, filtered and written.
//
//     ProbePlanOptions wanted;
//     wanted.density = 1;
//     auto plan = plan_probes(*scene, *sampler, wanted);
//     auto report = bake_probes(*scene, *sampler, plan->probes, plan->grid, {}, "probes");

#include "domelight/capture/capture.h"
#include "domelight/capture/placement.h"
#include "domelight/capture/probe_baker.h"
#include "domelight/probe/probe_set.h"
#include "domelight/texture/texture.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

struct ProbeBakeOptions {
    CaptureOptions capture;
    ProbeBakerOptions filter;                   ///< `size` is taken from `capture`
    Encoding encoding = Encoding::rgb9e5;       ///< of the light on disk: rgb9e5, rgba16f or rgba32f
    ProbeSource scene, environment;             ///< recorded
    std::string placement;                      ///< recorded: how the places were chosen, in words
    std::vector<std::filesystem::path> inputs;  ///< files that must not be overwritten
};

/// Records what probes are captured from (`scene` and `environment` of the options), keeps both from being overwritten,
/// and sets the farthest distance to the scene's diagonal.
///
/// name   a built-in scene, or the scene's file
///
/// Errors: those of reading the environment.
Result<void> set_sources(ProbeBakeOptions& options, const std::string& name, const Scene& scene,
                         const Environment& environment);

struct ProbeBakeReport {
    int size = 0;  ///< texels along a face of level 0
    std::int64_t rays = 0;
    double capture_seconds = 0, filter_seconds = 0;  ///< of processor time, all threads together
    std::int64_t non_finite_samples = 0;             ///< counted as black
    std::int64_t clipped_texels = 0;                 ///< brighter than the encoding can hold
    std::uint64_t bytes = 0;                         ///< of all files
};

/// Captures and filters valid probes, and writes probes.json, specular.ktx2, irradiance.ktx2 and distance.ktx2
/// (docs/probes.md) into a folder. All files appear together once they are complete. An invalid probe gets the maps of
/// the probe that it is filled from. Memory does not grow with the number of probes but for a kilobyte each.
///
/// Errors: an option out of its range (its field is named); no probes, or none with light of its own; a scene without
/// light; those of writing; "cancelled".
Result<ProbeBakeReport> bake_probes(const RayScene& scene, const EnvironmentSampler& sampler,
                                    const std::vector<Probe>& probes, const std::optional<ProbeGrid>& grid,
                                    const ProbeBakeOptions& options, const std::filesystem::path& folder);
/// The same in memory.
Result<ProbeSet> bake_probes(const RayScene& scene, const EnvironmentSampler& sampler, const std::vector<Probe>& probes,
                             const std::optional<ProbeGrid>& grid, const ProbeBakeOptions& options);

}  // namespace domelight
