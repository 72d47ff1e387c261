#pragma once
// Radiance's RGBE texels (Ward, "Real Pixels", Graphics Gems II): three 8-bit mantissas under one 8-bit exponent, value
// = mantissa 2^(e - 136).

#include <array>
#include <bit>
#include <cstdint>

namespace domelight {

/// Nearest RGBE of a colour: red, green, blue, exponent. The largest channel is off by at most half of one step of its
/// mantissa (2^-9 relative), the others by the same amount; rounding to the nearest keeps means. Negative values and
/// NaN become 0, values above 255 * 2^119 that.
///
/// Radiance's own tools truncate, and add half a step when they read; today's readers (and ours) decode the mantissa as
/// it is.
inline std::array<std::uint8_t, 4> rgbe_from_rgb(float r, float g, float b) {
    r = r > 0 ? r : 0.0f;  // false for NaN
    g = g > 0 ? g : 0.0f;
    b = b > 0 ? b : 0.0f;
    const float largest = r > g ? (r > b ? r : b) : (g > b ? g : b);
    // largest < 2^(field - 126), so that the mantissa largest * 2^(136 - e) with e = field + 2 is below 256.
    int exponent = int(std::bit_cast<std::uint32_t>(largest) >> 23) + 2;
    // In double: the scale reaches 2^134, and x + 1/2 must not round up by itself.
    const auto scale_of = [](int e) { return std::bit_cast<double>(std::uint64_t(1023 + 136 - e) << 52); };
    const auto mantissa = [](float v, double scale) { return int(double(v) * scale + 0.5); };
    if (exponent < 256 && mantissa(largest, scale_of(exponent)) == 256) ++exponent;
    if (exponent > 255) exponent = 255;
    const double scale = scale_of(exponent);
    const auto byte = [&](float v) {
        const double scaled = double(v) * scale + 0.5;
        return std::uint8_t(scaled < 255 ? int(scaled) : 255);
    };
    const std::array<std::uint8_t, 4> rgbe{byte(r), byte(g), byte(b), std::uint8_t(exponent)};
    if ((rgbe[0] | rgbe[1] | rgbe[2]) == 0) return {0, 0, 0, 0};
    return rgbe;
}

}  // namespace domelight
