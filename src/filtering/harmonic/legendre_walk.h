#pragma once

#include "filtering/harmonic/legendre_kernels.h"
#include "filtering/harmonic/ring_grid.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace domelight {

/// Walks up the degrees of the normalised associated Legendre functions of one order m on the northern rings,
///   Y_lm(theta, phi) = P_lm(cos theta) e^{i m phi},  orthonormal, without the Condon-Shortley sign,
/// a parity of l - m at a time: l = m + parity + 2 i. Southern rings follow from P_lm(-x) = (-1)^{l-m} P_lm(x).
///
/// From x P_l = e_{l+1} P_{l+1} + e_l P_{l-1}, e_l = sqrt((l^2 - m^2) / (4 l^2 - 1)), applied twice:
///   P_{l+2} = ((x^2 - e_{l+1}^2 - e_l^2) P_l - e_l e_{l-1} P_{l-2}) / (e_{l+1} e_{l+2}).
/// The recurrence is in double, which needs no special forms near the poles or the equator. P_mm ~ sin^m theta exceeds
/// even the range of doubles, so each group of rings starts with its own scale and takes part only once its values can
/// matter.
class LegendreWalk {
  public:
    /// The number of degrees in one call of visit().
    static constexpr int k_chunk = 16;

    LegendreWalk(const NorthernRings& rings, int band_limit);

    /// Degrees of this order and parity, rounded up to an even number (the kernels take pairs; what is above the band
    /// limit is to be ignored or zero).
    static int padded_count(int band_limit, int m, int parity) {
        const int count = band_limit - m - parity >= 0 ? (band_limit - m - parity) / 2 + 1 : 0;
        return count + count % 2;
    }

    /// Calls visit(first, count, first_ring, p): p[i * padded + ring] holds P_l, l = m + parity + 2 (first + i), for i
    /// < count and rings from first_ring on; on rings before it they are below 1e-13.
    template <typename Visit>
    void walk(int m, int parity, const Visit& visit) {
        start(m, parity);
        const int count = padded_count(band_limit_, m, parity);
        for (int first = 0; first < count; first += k_chunk) {
            const int n = std::min(k_chunk, count - first);
            const int first_ring = advance(first, n);
            if (first_ring < rings_.padded) visit(first, n, first_ring, rows_.data());
        }
    }

  private:
    void start(int m, int parity);
    int advance(int first, int count);
    void advance_waiting_group(int group, int first, int count);

    const NorthernRings& rings_;
    int band_limit_;
    std::vector<double> log_norm_;  ///< log of P_mm / sin^m theta
    std::vector<simd::LegendreStep> steps_;
    AlignedArray<double> p_, p_prev_;
    AlignedArray<float> rows_;       ///< [k_chunk][padded]
    std::vector<double> log_scale_;  ///< of each group; p_ holds P / exp(log_scale)
    std::vector<double> wake_;       ///< of each waiting group: the scaled value at which it must be looked at
    std::vector<bool> active_;       ///< the group's values are at their true scale and large enough to matter
    int first_possible_ = 0;         ///< groups before this one stay negligible up to the band limit
};

}  // namespace domelight
