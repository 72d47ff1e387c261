#pragma once

#include "domelight/bake.h"

#include "bake/plan.h"

#include <cstddef>
#include <vector>

namespace domelight {

/// The maps of several targets as one filter run: what two targets share is computed once.
class FilterJob {
  public:
    explicit FilterJob(const std::vector<TargetPlan>& plans);

    /// Reads the environment once, to its last row, and computes everything.
    Result<void> run(Environment& environment, const BakeOptions& options);

    /// A target's maps, handed out and taken back so that the next target finds them.
    struct Maps {
        std::vector<FilteredMap> specular, sheen;
        FilteredMap irradiance_over_pi;
    };
    Maps take(std::size_t target);
    void give_back(std::size_t target, Maps maps);

    const FilterResult& result() const { return result_; }
    /// SHA-256 of the rows that were read, as float32: what stands for the source's hash where there is no file.
    const std::string& rows_sha256() const { return rows_sha256_; }

  private:
    struct Indices {
        std::vector<std::size_t> specular, sheen;
        std::size_t irradiance = 0;
    };
    std::size_t add(const LevelSpec& spec);
    Result<void> filter_rows(RowSource& rows, const FilterOptions& filter, const BakeOptions& options);
    Result<void> filter_cube(const Environment& environment, const FilterOptions& filter, const BakeOptions& options);
    std::vector<FilteredMap> take(const std::vector<std::size_t>& indices);
    void give_back(const std::vector<std::size_t>& indices, std::vector<FilteredMap> maps);

    Layout layout_ = Layout::cube;
    std::vector<Indices> targets_;
    std::vector<LevelSpec> specs_;         ///< distinct levels
    std::vector<int> panorama_heights_;    ///< distinct lat-long resamplings for targets that filter by themselves
    std::vector<int> irradiance_sizes_;    ///< distinct sizes
    FilterResult result_;                  ///< specular: one for each of specs_, then one for each of panorama_heights_
    std::vector<FilteredMap> irradiance_;  ///< E / pi, one for each of irradiance_sizes_
    std::string rows_sha256_;
};

}  // namespace domelight
