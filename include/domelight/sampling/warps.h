#pragma once

#include "domelight/base/unit_point.h"
#include "domelight/base/vec.h"

#include <algorithm>
#include <cstdint>

namespace domelight {

/// The point of the unit circle at the angle 2 pi turn / 2^32: x its cosine, y its sine.
struct CirclePoint {
    float x, y;
};

/// Within 1.2e-7 of the exact point, in about a third of the time of std::sin and std::cos, with the same bits for
/// every C library. The nearest quarter turn is exact in fixed point; the rest is evaluated by Taylor's series.
inline CirclePoint circle_point(std::uint32_t turn) {
    const std::uint32_t quarter = (turn + 0x20000000u) >> 30;             // the nearest quarter turn, 0..3
    const auto rest = std::int32_t(turn - (quarter << 30));               // -1/8 .. 1/8 turn
    const float x = float(rest) * float(2 * k_pi * 0x1p-32), x2 = x * x;  // |x| <= pi / 4
    const float s =
        x + x * x2 * (-1.66666667e-1f + x2 * (8.33333333e-3f + x2 * (-1.98412698e-4f + x2 * 2.75573192e-6f)));
    const float c = 1 + x2 * (-0.5f + x2 * (4.16666667e-2f + x2 * (-1.38888889e-3f + x2 * 2.48015873e-5f)));
    const float a = quarter & 1 ? s : c, b = quarter & 1 ? c : s;
    return {(quarter + 1) & 2 ? -a : a, quarter & 2 ? -b : b};
}

/// A direction of the upper hemisphere (z > 0) with density z / pi per steradian: u.x is the squared sine of the polar
/// angle, u.y chooses the azimuth.
inline Vec3f cosine_hemisphere(UnitPoint u) {
    const float sin2 = unit_float(u.x), s = std::sqrt(sin2);
    const CirclePoint azimuth = circle_point(u.y);
    return {s * azimuth.x, s * azimuth.y, std::sqrt(1 - sin2)};
}

/// A direction of the upper hemisphere (z > 0) with density 1 / (2 pi) per steradian.
inline Vec3f uniform_hemisphere(UnitPoint u) {
    const float q = unit_float(u.x), s = std::sqrt(q * (2 - q));
    const CirclePoint azimuth = circle_point(u.y);
    return {s * azimuth.x, s * azimuth.y, 1 - q};
}

}  // namespace domelight
