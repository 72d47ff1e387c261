#pragma once

#include <cstdint>

namespace domelight {

/// A point of the unit square in 32-bit fixed point: (x, y) / 2^32, so in [0, 1) by construction.
///
/// Sequences return such points and samplers take them. A random float in [0, 1) is a multiple of 2^-24: with floats a
/// texel that holds less than 2^-24 of its row's sum might never be drawn, and the position within a texel of small
/// weight would have few bits. Cumulative tables in 32-bit fixed point distinguish all 2^32 values.
struct UnitPoint {
    std::uint32_t x = 0, y = 0;
    constexpr bool operator==(const UnitPoint&) const = default;
};

/// A 32-bit fixed-point fraction as a number in [0, 1); exact in double.
constexpr double unit_double(std::uint32_t u) {
    return u * 0x1p-32;
}
/// The same in float, rounded down so that it stays under 1.
constexpr float unit_float(std::uint32_t u) {
    return float(u >> 8) * 0x1p-24f;
}
/// A number in [0, 1) as a fraction, rounded down. Numbers outside are clamped to the nearest fraction; NaN becomes 0.
constexpr std::uint32_t unit_fixed(double u) {
    if (!(u > 0)) return 0;
    return u >= 1 ? 0xffffffffu : std::uint32_t(u * 0x1p32);
}

}  // namespace domelight
