#pragma once
// Three 9-bit mantissas with one 5-bit exponent (bias 15), red in the low bits, exponent in the top ones.
// EXT_texture_shared_exponent; Vulkan's E5B9G9R9_UFLOAT_PACK32, DXGI's R9G9B9E5_SHAREDEXP.

#include "domelight/base/vec.h"

#include <bit>
#include <cstdint>

namespace domelight {

/// (2^9 - 1) / 2^9 * 2^(31 - 15)
inline constexpr float k_rgb9e5_max = 65408;

/// EXT_texture_shared_exponent, section 3.8.x ("sharedexp_max ... exp_shared"): clamp, exponent of the largest channel,
/// one more where that channel rounds up to 2^9, mantissas rounded half up. NaN and negative values become 0.
inline std::uint32_t rgb9e5_from_rgb(const Vec3f& rgb) {
    const auto clamp = [](float v) {
        v = v > 0 ? v : 0.0f;  // false for NaN
        return v < k_rgb9e5_max ? v : k_rgb9e5_max;
    };
    const float r = clamp(rgb.x), g = clamp(rgb.y), b = clamp(rgb.z);
    float largest = r > g ? r : g;
    largest = largest > b ? largest : b;

    // floor(log2(largest)) is the float's own exponent; subnormal floats are below the clamp at -B - 1 = -16 in any
    // case.
    const int floor_log2 = int(std::bit_cast<std::uint32_t>(largest) >> 23) - 127;
    int exponent = (floor_log2 > -16 ? floor_log2 : -16) + 1 + 15;
    // 1 / 2^(exponent - B - N), a power of two within float's range.
    const auto inverse_step = [](int e) { return std::bit_cast<float>(std::uint32_t(127 + 24 - e) << 23); };
    const auto mantissa = [](float v, float scale) { return std::uint32_t(v * scale + 0.5f); };
    if (mantissa(largest, inverse_step(exponent)) == 512) ++exponent;
    const float scale = inverse_step(exponent);
    return mantissa(r, scale) | mantissa(g, scale) << 9 | mantissa(b, scale) << 18 | std::uint32_t(exponent) << 27;
}

/// mantissa * 2^(exponent - 15 - 9) (exact)
inline Vec3f rgb_from_rgb9e5(std::uint32_t packed) {
    const float step = std::bit_cast<float>(((packed >> 27) + 127 - 24) << 23);
    return {float(packed & 511u) * step, float(packed >> 9 & 511u) * step, float(packed >> 18 & 511u) * step};
}

}  // namespace domelight
