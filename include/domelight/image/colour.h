#pragma once

#include "domelight/base/vec.h"

namespace domelight {

/// Luminance Y of linear Rec. 709 values (ITU-R BT.709-6, item 3.2), in their unit.
template <typename T>
constexpr T luminance(const Vec3<T>& rgb) {
    return T(0.2126) * rgb.x + T(0.7152) * rgb.y + T(0.0722) * rgb.z;
}

/// The same for the three floats of a pixel.
constexpr double luminance(const float* rgb) {
    return luminance(Vec3d{rgb[0], rgb[1], rgb[2]});
}

}  // namespace domelight
