#pragma once

#include "filtering/harmonic/batch_fft.h"
#include "filtering/harmonic/legendre_table.h"
#include "filtering/harmonic/ring_grid.h"

#include <memory>

namespace domelight {

/// What the transforms between rows of an image and spherical harmonics need besides the values. It may serve any number of
/// transforms, also at the same time.
struct RingTransform {
    /// width            points of a row
    /// keeps_legendre   whether the Legendre functions are computed once and kept, or anew in each transform
    explicit RingTransform(int width, int band_limit_, bool keeps_legendre = false)
        : band_limit(band_limit_), grid(ring_grid_for(band_limit)), north(grid.rings), fft(width) {
        if (keeps_legendre) legendre = std::make_unique<LegendreTable>(north, band_limit);
    }

    /// Calls use(walk, begin, end) for the orders begin .. end - 1, where walk.walk(m, parity, visit) gives the Legendre
    /// functions.
    template <typename Use>
    void with_legendre(int begin, int end, const Use& use) const {
        if (legendre) return use(*legendre, begin, end);
        LegendreWalk walk(north, band_limit);
        use(walk, begin, end);
    }

    int band_limit;
    RingGrid grid;  ///< of ring_grid_for(band_limit)
    NorthernRings north;
    simd::BatchFft fft;
    std::unique_ptr<const LegendreTable> legendre;  ///< may be null
};

/// For functions on the points of ring_grid_for(band_limit).
inline std::shared_ptr<const RingTransform> grid_transform(int band_limit, bool keeps_legendre = false) {
    return std::make_shared<RingTransform>(ring_grid_for(band_limit).width, band_limit, keeps_legendre);
}

}  // namespace domelight
