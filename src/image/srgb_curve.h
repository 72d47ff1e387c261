#pragma once

#include <cmath>

namespace domelight {

/// The linear value of a value of sRGB (IEC 61966-2-1, section 5.2). Above 1 the power goes on; negative values get the
/// curve of their magnitude.
inline double srgb_to_linear(double v) {
    if (v < 0) return -srgb_to_linear(-v);
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

}  // namespace domelight
