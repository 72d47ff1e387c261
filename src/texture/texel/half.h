#pragma once
// IEEE 754 binary16, the plain scalar form. Any other implementation is tested against this one.

#include <bit>
#include <cstdint>

namespace domelight {

inline constexpr float k_half_max = 65504;

/// Nearest half of a float, ties to even; NaN stays NaN, values from 65520 up become infinite, below 2^-25 zero.
inline std::uint16_t half_from_float(float value) {
    std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = bits >> 16 & 0x8000u;
    bits &= 0x7fffffffu;
    if (bits >= 0x47800000u) return std::uint16_t(sign | (bits > 0x7f800000u ? 0x7e00u : 0x7c00u));
    if (bits < 0x38800000u) {
        // Subnormal: the ulp of 0.5f is 2^-24, a half's smallest step, so the float addition rounds for us.
        const float sum = std::bit_cast<float>(bits) + 0.5f;
        return std::uint16_t(sign | (std::bit_cast<std::uint32_t>(sum) - 0x3f000000u));
    }
    // Rebias the exponent from 127 to 15; add just under half a step, and the last bit kept, so that ties go to even.
    bits += 0xc8000fffu + (bits >> 13 & 1u);
    return std::uint16_t(sign | bits >> 13);
}

/// The float of the same value (exact).
inline float float_from_half(std::uint16_t half) {
    const std::uint32_t sign = std::uint32_t(half & 0x8000u) << 16, exponent = half >> 10 & 31u,
                        mantissa = half & 1023u;
    if (exponent == 0) {
        const float magnitude = float(mantissa) * 0x1p-24f;
        return sign ? -magnitude : magnitude;
    }
    if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000u | mantissa << 13);
    return std::bit_cast<float>(sign | (exponent + 112) << 23 | mantissa << 13);
}

}  // namespace domelight
