#pragma once
// Packed unsigned floats without sign: red and green with 6, blue with 5 bits of mantissa, 5 bits of exponent (bias 15)
// each; red in the low bits. OpenGL 4.6 core specification, sections 2.3.4.3 and 2.3.4.4; Vulkan's
// B10G11R11_UFLOAT_PACK32, DXGI's R11G11B10_FLOAT.

#include "domelight/base/vec.h"

#include <bit>
#include <cstdint>

namespace domelight {

inline constexpr float k_float11_max = 65024, k_float10_max = 64512;

/// Nearest unsigned float with `mantissa_bits` (6 or 5) and 5 exponent bits, ties to even. NaN and negative values
/// become 0, large ones the largest finite value.
template <int mantissa_bits>
std::uint32_t small_float_from_float(float value) {
    constexpr float k_max = mantissa_bits == 6 ? k_float11_max : k_float10_max;
    constexpr int k_shift = 23 - mantissa_bits;
    value = value > 0 ? value : 0.0f;  // false for NaN
    value = value < k_max ? value : k_max;
    std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    if (bits < 0x38800000u) {
        // Below 2^-14: the ulp of this constant is the smallest step, 2^(-14 - mantissa_bits), so the addition rounds
        // for us.
        constexpr float k_align = float(1 << (9 - mantissa_bits));
        return std::bit_cast<std::uint32_t>(value + k_align) - std::bit_cast<std::uint32_t>(k_align);
    }
    bits += 0xc8000000u + ((1u << (k_shift - 1)) - 1) + (bits >> k_shift & 1u);
    return bits >> k_shift;
}

/// The float of the same value (exact).
template <int mantissa_bits>
float float_from_small_float(std::uint32_t bits) {
    const std::uint32_t exponent = bits >> mantissa_bits & 31u, mantissa = bits & ((1u << mantissa_bits) - 1);
    if (exponent == 0) return float(mantissa) * (0x1p-14f / (1 << mantissa_bits));
    const std::uint32_t biased = exponent == 31 ? 255u : exponent + 112;
    return std::bit_cast<float>(biased << 23 | mantissa << (23 - mantissa_bits));
}

inline std::uint32_t r11g11b10f_from_rgb(const Vec3f& rgb) {
    return small_float_from_float<6>(rgb.x) | small_float_from_float<6>(rgb.y) << 11 |
           small_float_from_float<5>(rgb.z) << 22;
}

inline Vec3f rgb_from_r11g11b10f(std::uint32_t packed) {
    return {float_from_small_float<6>(packed & 0x7ffu), float_from_small_float<6>(packed >> 11 & 0x7ffu),
            float_from_small_float<5>(packed >> 22)};
}

}  // namespace domelight
