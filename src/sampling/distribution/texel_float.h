#pragma once

#include "domelight/sampling/distribution/distribution.h"

#include "sampling/distribution/weight_rows.h"

#include <algorithm>
#include <array>

namespace domelight {

/// x in [i, i + 1) / n as float, moved by a float's step where rounding would have left texel i: floor(double(result) *
/// n) == i. n <= 65535, so that a texel holds 256 floats or more. The SIMD kernels do the same, operation by operation.
inline float texel_float(double x, double i, double n) {
    const double f = float(x), back = f * n;  // exact: 24 + 16 bits
    if (back >= i + 1) return float(f * (1 - 1.5 * 0x1p-24));
    if (back < i) return float(f * (1 + 1.5 * 0x1p-24));
    return float(f);
}

/// A drawn point in float: in [0, 1), and with piecewise-constant densities in its texel.
inline std::array<float, 2> float_point(const DistributionSample& s, int width, int height, bool continuous) {
    if (continuous) return {std::min(float(s.u), 0x1.fffffep-1f), std::min(float(s.v), 0x1.fffffep-1f)};
    return {texel_float(s.u, texel_index(s.u, width), width), texel_float(s.v, texel_index(s.v, height), height)};
}

}  // namespace domelight
