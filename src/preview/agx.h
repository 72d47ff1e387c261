#pragma once

#include "preview/tonemap.h"

#include <algorithm>
#include <cmath>

namespace domelight {

// AgX: into its primaries, a contrast curve over log2, a look, and out again to a display of gamma 2.2. Matrices and
// range as in Blender's configuration, the curve by B. Wrensch's polynomial of the sixth degree; the punchy look is a
// power of 1.35 and a saturation of 1.4.
inline constexpr float k_agx_least_ev = -12.47393f, k_agx_most_ev = 4.026069f;

inline float agx_curve(float linear, bool punchy) {
    const float ev = std::log2(std::max(linear, 1e-10f));
    const float x = std::clamp((ev - k_agx_least_ev) / (k_agx_most_ev - k_agx_least_ev), 0.0f, 1.0f);
    const float x2 = x * x, x4 = x2 * x2;
    const float y =
        15.5f * x4 * x2 - 40.14f * x4 * x + 31.96f * x4 - 6.868f * x2 * x + 0.4298f * x2 + 0.1191f * x - 0.00232f;
    return punchy ? std::pow(std::max(y, 0.0f), 1.35f) : y;
}

inline Vec3f agx_inset(const Vec3f& v) {
    return {0.842479062f * v.x + 0.0784336f * v.y + 0.0792237451f * v.z,
            0.0423282422f * v.x + 0.878468636f * v.y + 0.0791661275f * v.z,
            0.0423756549f * v.x + 0.0784336f * v.y + 0.879142974f * v.z};
}

/// From the curve's values to display values of gamma 2.2, not yet clipped to 0..1. Linear.
inline Vec3f agx_outset(Vec3f v, bool punchy) {
    if (punchy) {
        const float grey = luminance(v);
        v = Vec3f{grey, grey, grey} + (v - Vec3f{grey, grey, grey}) * 1.4f;
    }
    return {1.196879005f * v.x - 0.0980208811f * v.y - 0.0990297441f * v.z,
            -0.0528968518f * v.x + 1.15190313f * v.y - 0.0989611768f * v.z,
            -0.0529716355f * v.x - 0.0980434501f * v.y + 1.15107367f * v.z};
}

}  // namespace domelight
