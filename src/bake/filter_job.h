#pragma once

#include "domelight/bake/bake.h"

#include "bake/plan.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace domelight {

/// The maps of several engines as one filter run: what two engines share is computed once.
class FilterJob {
  public:
    explicit FilterJob(const std::vector<EnginePlan>& plans);

    /// Reads the environment once, to its last row, and computes everything.
    Result<void> run(Environment& environment, const BakeOptions& options);

    /// An engine's maps, handed out and taken back so that the next engine finds them.
    struct Maps {
        std::vector<FilteredMap> specular, sheen;
        FilteredMap irradiance_over_pi;
        ImageF panorama;  ///< the environment as one image, in the engine's projection
    };
    Maps take(std::size_t engine);
    void give_back(std::size_t engine, Maps maps);

    /// Of the run that made an engine's maps.
    const FilterResult& result(std::size_t engine) const { return runs_[engines_[engine].run].result; }
    std::int64_t clamped() const;
    int band_limit() const;
    /// SHA-256 of the rows that were read, as float32: what stands for the source's hash where there is no file.
    const std::string& rows_sha256() const { return rows_sha256_; }

  private:
    struct Indices {
        std::size_t run = 0;
        std::vector<std::size_t> specular, sheen;
        std::size_t irradiance = 0;
        std::optional<std::size_t> panorama;
    };
    /// All maps of one layout: one analysis of the environment.
    struct Run {
        Layout layout = Layout::cube;
        std::vector<LevelSpec> specs;         ///< distinct levels
        std::vector<int> irradiance_sizes;    ///< distinct sizes
        FilterResult result;                  ///< specular: one for each of specs
        std::vector<FilteredMap> irradiance;  ///< E / pi, one for each of irradiance_sizes
        std::size_t add(const LevelSpec& spec);
        FilterOptions options(const Environment& environment, const BakeOptions& options) const;
        /// Moves E / pi out of the result's levels, where all sizes but the first were computed.
        void sort_out();
    };
    std::size_t run_of(Layout layout);
    Result<void> read_rows(Environment& environment, const BakeOptions& options);
    Result<void> filter_cube(Environment& environment, const BakeOptions& options);
    static std::vector<FilteredMap> take(Run& run, const std::vector<std::size_t>& indices);
    static void give_back(Run& run, const std::vector<std::size_t>& indices, std::vector<FilteredMap> maps);

    std::vector<Run> runs_;
    std::vector<Indices> engines_;
    std::vector<PanoramaSpec> panorama_specs_;  ///< distinct ones
    std::vector<ImageF> panoramas_;             ///< one for each of panorama_specs_
    std::string rows_sha256_;
};

}  // namespace domelight
