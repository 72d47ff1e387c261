#pragma once

namespace domelight {

/// x in [i, i + 1) / n as float, moved by a float's step where rounding would have left texel i: floor(double(result) * n) == i.
/// n <= 65535, so that a texel holds 256 floats or more. The SIMD kernels do the same, operation by operation.
inline float texel_float(double x, double i, double n) {
    const double f = float(x), back = f * n;  // exact: 24 + 16 bits
    if (back >= i + 1) return float(f * (1 - 1.5 * 0x1p-24));
    if (back < i) return float(f * (1 + 1.5 * 0x1p-24));
    return float(f);
}

}  // namespace domelight
