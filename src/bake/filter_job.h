#pragma once

#include "domelight/bake/bake.h"

#include "bake/plan.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace domelight {

/// The maps of several engines from one reading of the environment. Each engine's maps have the same bits as when it is
/// baked alone. Engines that want the same levels share one filter run.
class FilterJob {
  public:
    /// The plans must outlive the job.
    FilterJob(const std::vector<EnginePlan>& plans, const Environment& environment, const BakeOptions& options);

    /// Reads the environment once, to its last row, and computes everything.
    Result<void> run(const Environment& environment, const BakeOptions& options);

    /// An engine's maps, which the job keeps: engines share them.
    struct Maps {
        std::span<const FilteredMap> specular, sheen;
        std::span<const FilteredMap> gap_probes;  ///< of EnginePlan::gap_probes
        const FilteredMap* irradiance_over_pi = nullptr;
        /// The environment as one image, in the engine's projection; null where the engine takes none.
        const FilteredMap* panorama = nullptr;
    };
    Maps maps(std::size_t engine) const;

    /// Of the run that made an engine's maps.
    const FilterResult& result(std::size_t engine) const { return results_[engines_[engine].run]; }
    std::int64_t clamped() const;
    int band_limit() const;
    /// SHA-256 of the rows that were read, as float32: used as the source's hash if there is no file.
    const std::string& rows_sha256() const { return rows_sha256_; }

  private:
    struct Indices {
        const EnginePlan* plan = nullptr;
        std::size_t run = 0;
        std::optional<std::size_t> panorama;
    };
    Result<void> read_rows(const Environment& environment, const BakeOptions& options);
    Result<void> filter_cube(const Environment& environment, const BakeOptions& options);

    std::vector<FilterOptions> runs_;    ///< distinct ones
    std::vector<FilterResult> results_;  ///< one for each of runs_
    std::vector<Indices> engines_;
    std::vector<PanoramaSpec> panorama_specs_;  ///< distinct ones
    std::vector<FilteredMap> panoramas_;        ///< one for each of panorama_specs_
    std::string rows_sha256_;
};

}  // namespace domelight
