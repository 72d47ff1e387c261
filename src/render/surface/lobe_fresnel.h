#pragma once

#include "domelight/base/vec.h"

#include <algorithm>
#include <cmath>

namespace domelight {

/// Reflectance of a smooth boundary between two clear media for unpolarised light, [0, 1].
///
/// cosine  of the angle of incidence, [0, 1]
/// eta     index beyond the boundary over the index before it
/// returns 1 beyond the critical angle. Walter et al. 2007, eq. 22.
inline float fresnel_dielectric(float cosine, float eta) {
    const float c = std::min(cosine, 1.f), g2 = eta * eta - 1 + c * c;
    if (g2 <= 0) return 1;
    const float g = std::sqrt(g2), a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);
    return std::min(1.f, 0.5f * a * a * (1 + b * b));
}

/// The same as a weight between F0 (0) and 1, where Schlick has (1 - c)^5: a boundary between equals has none at any
/// angle, and both sides of one agree.
inline float fresnel_weight(float cosine, float eta) {
    const float ratio = (eta - 1) / (eta + 1), f0 = ratio * ratio;
    return f0 < 1 ? std::clamp((fresnel_dielectric(cosine, eta) - f0) / (1 - f0), 0.f, 1.f) : 1;
}

}  // namespace domelight
