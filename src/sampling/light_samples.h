#pragma once

#include <array>
#include <cstddef>

namespace domelight::simd {

/// A lat-long RGB image to look radiance up in: bilinearly (u wraps, v clamps), or the texel's own.
struct LightImage {
    const float* rgb;
    std::ptrdiff_t stride;
    int width, height;
    bool bilinear;
};

/// Completes drawn points: directions (turned by the rows of `to_world`), radiance, and pdf from per unit square to per
/// steradian in place, pdf / (2 pi^2 max(sin theta, least_sine)).
void complete_light_samples(const LightImage& image, const std::array<float, 9>& to_world, int count, float least_sine,
                            const float* u, const float* v, float* pdf, const std::array<float*, 3>& direction,
                            const std::array<float*, 3>& radiance);

/// The inverse: the points of directions (of any length but 0), turned by the rows of `to_source`, the sine of their
/// polar angle, and the radiance there. u, v in [0, 1), within 1e-7.
void look_up_light_samples(const LightImage& image, const std::array<float, 9>& to_source, int count,
                           const std::array<const float*, 3>& direction, float* u, float* v, float* sine,
                           const std::array<float*, 3>& radiance);

}  // namespace domelight::simd
