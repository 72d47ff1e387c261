#pragma once

#include "domelight/filtering/prefilter.h"

#include "filtering/harmonic/ring_grid.h"

#include <vector>

namespace domelight {

/// How the exact filter goes about its levels: which band limit each one needs, and which are synthesised together.
struct FilterPlan {
    /// Levels that share a grid; the walk over the Legendre functions serves them all.
    struct Group {
        int band_limit = 0;
        RingGrid grid;
        bool narrow = false;
        std::vector<int> levels;  ///< indices of FilterOptions::specular; k_irradiance for the irradiance map
    };
    static constexpr int k_irradiance = -1;

    int band_limit = 0;       ///< of the analysis
    int wide_band_limit = 0;  ///< of all levels that are not narrow
    /// There are narrow levels: what outshines the rest by far is better taken out of a lat-long image before it is
    /// expanded (BrightSplit).
    bool split = false;
    std::vector<Group> groups;
    std::vector<int> direct;  ///< levels that are summed over the rows (DirectSums), indices of FilterOptions::specular
};

/// sums_directly   whether levels may be summed over the rows of a lat-long image; else all are expanded
FilterPlan make_filter_plan(const FilterOptions& options, bool sums_directly);

/// Degrees that a lobe needs for the accuracy that docs/math/prefilter.md states; fewer where the brightest texels are
/// taken out (`split`).
int required_band_limit(const ZonalKernel& kernel, bool split);

/// Whether the clamp at the horizon leaves a tail that a strong sun shows: what is left out is then summed over the
/// brightest texels.
bool leaves_residual(const ZonalKernel& kernel);

}  // namespace domelight
