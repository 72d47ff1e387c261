#pragma once

#include "domelight/filtering/prefilter.h"

#include "filtering/harmonic/ring_grid.h"

#include <vector>

namespace domelight {

/// The plan of the exact filter: the band limit that each level needs, and which levels are synthesised together.
struct FilterPlan {
    /// Levels that share a grid. The Legendre functions are computed once for all of them.
    struct Group {
        int band_limit = 0;
        RingGrid grid;
        bool narrow = false;
        std::vector<int> levels;  ///< indices of FilterOptions::specular; k_irradiance for the irradiance map
    };
    static constexpr int k_irradiance = -1;

    int band_limit = 0;       ///< of the analysis
    int wide_band_limit = 0;  ///< of all levels that are not narrow
    /// There are narrow levels, so texels much brighter than the rest should be removed from a lat-long image before it
    /// is expanded (BrightSplit).
    bool split = false;
    std::vector<Group> groups;
    std::vector<int> direct;  ///< levels that are summed over the rows (DirectSums), indices of FilterOptions::specular
};

/// The degrees that a wide lobe needs at least, because of the clamp at the horizon.
inline constexpr int k_least_degrees = 256;
/// The same for a cube with faces of this width: its texels' tents have little light in degrees above twice that, which
/// matters where small cubes are filtered many times a second. (Faces of 64^2 and 32^2 of five photographs: an RMSE of
/// 1.4e-5 and a largest error of 4e-4 against 256 degrees.)
int least_degrees(int face_size);

/// To which degrees lobes are expanded.
struct DegreeLimits {
    int least = k_least_degrees;  ///< of a wide lobe
    /// A lobe's spectrum falls as e^(-b l), b its width; it is expanded to b l = `decay`.
    double decay = 16.6;
};

/// sums_directly   whether levels may be summed over the rows of a lat-long image; else all are expanded
FilterPlan make_filter_plan(const FilterOptions& options, bool sums_directly, const DegreeLimits& degrees = {});

/// The degrees that a lobe needs for the accuracy stated in docs/math/prefilter.md; fewer if the brightest texels are
/// removed (`split`).
int required_band_limit(const ZonalKernel& kernel, bool split, const DegreeLimits& degrees = {});

/// Whether the clamp at the horizon leaves a tail that a strong sun makes visible. The truncated part is then summed
/// over the brightest texels.
bool leaves_residual(const ZonalKernel& kernel);

}  // namespace domelight
