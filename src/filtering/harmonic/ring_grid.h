#pragma once

#include "base/aligned.h"

namespace domelight {

/// Rings of equal latitude that hold a function on the sphere: ring k at theta_k = pi (k + 1/2) / rings, `width` points
/// a ring at phi_i = 2 pi i / width. rings is even, so every ring has its mirror in the other hemisphere.
struct RingGrid {
    int rings = 0;
    int width = 0;
    bool operator==(const RingGrid&) const = default;
};

/// A grid dense enough to interpolate a function of this band limit with 8 taps (about 1.45 times the least number of
/// rings), of a size whose transforms are fast.
RingGrid ring_grid_for(int band_limit);

/// The northern rings of a grid, padded for the kernels; the padding lies on the equator and is never read.
struct NorthernRings {
    explicit NorthernRings(int rings);
    int count;   ///< rings / 2
    int padded;  ///< count rounded up to the kernels' group
    AlignedArray<double> cos_theta, sin_theta, cos2_theta, log_sin_theta;
};

}  // namespace domelight
