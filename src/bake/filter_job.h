#pragma once

#include "domelight/bake/bake.h"

#include "bake/plan.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace domelight {

/// The maps of several engines from one reading of the environment. Each engine's maps have the same bits as when it is
/// baked alone. Engines that want the same levels share one filter run.
class FilterJob {
  public:
    FilterJob(const std::vector<EnginePlan>& plans, const Environment& environment, const BakeOptions& options);

    /// Reads the environment once, to its last row, and computes everything.
    Result<void> run(const Environment& environment, const BakeOptions& options);

    /// An engine's maps. They are lent to one engine and returned for the next.
    struct Maps {
        std::vector<FilteredMap> specular, sheen;
        std::vector<FilteredMap> gap_probes;  ///< of EnginePlan::gap_probes
        FilteredMap irradiance_over_pi;
        ImageF panorama;  ///< the environment as one image, in the engine's projection
    };
    Maps take(std::size_t engine);
    void give_back(std::size_t engine, Maps maps);

    /// Of the run that made an engine's maps.
    const FilterResult& result(std::size_t engine) const { return results_[engines_[engine].run]; }
    std::int64_t clamped() const;
    int band_limit() const;
    /// SHA-256 of the rows that were read, as float32: used as the source's hash if there is no file.
    const std::string& rows_sha256() const { return rows_sha256_; }

  private:
    struct Indices {
        std::size_t run = 0;
        /// The run's levels are the specular ones, then those of the sheen, then the probes of the gaps.
        std::size_t specular_count = 0, sheen_count = 0;
        std::optional<std::size_t> panorama;
    };
    Result<void> read_rows(const Environment& environment, const BakeOptions& options);
    Result<void> filter_cube(const Environment& environment, const BakeOptions& options);

    std::vector<FilterOptions> runs_;    ///< distinct ones
    std::vector<FilterResult> results_;  ///< one for each of runs_
    std::vector<Indices> engines_;
    std::vector<PanoramaSpec> panorama_specs_;  ///< distinct ones
    std::vector<ImageF> panoramas_;             ///< one for each of panorama_specs_
    std::string rows_sha256_;
};

}  // namespace domelight
