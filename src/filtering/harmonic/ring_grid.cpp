#include "filtering/harmonic/ring_grid.h"

#include "domelight/base/vec.h"

#include "filtering/harmonic/legendre_kernels.h"

#include <algorithm>
#include <cmath>

namespace domelight {

RingGrid ring_grid_for(int band_limit) {
    const int least = std::max(16, int(std::ceil(1.44 * (band_limit + 1))));
    // Widths are 2^a times a few threes and fives: at most 1/16 more than asked for, and nearly all passes have radix
    // 4.
    int best = 1 << 30;
    for (int odd : {1, 3, 5, 9, 15, 25, 27, 45, 75}) {
        int rings = 2 * odd;
        while (rings < least) rings *= 2;
        best = std::min(best, rings);
    }
    return {best, 2 * best};
}

NorthernRings::NorthernRings(int rings)
    : count(rings / 2),
      padded((count + simd::k_ring_group - 1) / simd::k_ring_group * simd::k_ring_group),
      cos_theta(padded),
      sin_theta(padded),
      cos2_theta(padded),
      log_sin_theta(padded) {
    for (int k = 0; k < padded; ++k) {
        const double theta = k < count ? k_pi * (k + 0.5) / rings : k_pi / 2;
        cos_theta[k] = k < count ? std::cos(theta) : 0;
        sin_theta[k] = std::sin(theta);
        cos2_theta[k] = cos_theta[k] * cos_theta[k];
        log_sin_theta[k] = std::log(sin_theta[k]);
    }
}

}  // namespace domelight
