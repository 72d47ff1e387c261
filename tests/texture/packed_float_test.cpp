#include "test.h"
#include "texture/texel/r11g11b10f.h"
#include "texture/texel/rgb9e5.h"
#include "texture/texel/rgbe.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace domelight;

namespace {

/// Pseudo-random positive floats over `stops` powers of two below `top`.
struct Floats {
    std::mt19937 bits{12345};
    float next(float top, int stops) {
        const float mantissa = 1 + float(bits() >> 9) * 0x1p-23f;
        return std::ldexp(top * mantissa / 2, -int(bits() % unsigned(stops)));
    }
};

template <int mantissa_bits>
void check_small_float(float max) {
    const std::uint32_t count = 31u << mantissa_bits;  // finite ones
    for (std::uint32_t bits = 0; bits < count; ++bits) {
        const float f = float_from_small_float<mantissa_bits>(bits);
        REQUIRE(small_float_from_float<mantissa_bits>(f) == bits);
        if (bits + 1 == count) break;
        const float middle = (f + float_from_small_float<mantissa_bits>(bits + 1)) / 2;
        REQUIRE(small_float_from_float<mantissa_bits>(middle) == (bits % 2 ? bits + 1 : bits));
        REQUIRE(small_float_from_float<mantissa_bits>(std::nextafter(middle, 0.0f)) == bits);
        REQUIRE(small_float_from_float<mantissa_bits>(std::nextafter(middle, 1e9f)) == bits + 1);
    }
    CHECK(float_from_small_float<mantissa_bits>(count - 1) == max);
    for (float high : {max * 1.001f, 1e30f, std::numeric_limits<float>::infinity()})
        CHECK(small_float_from_float<mantissa_bits>(high) == count - 1);
    for (float zero : {0.0f, -1.0f, -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()})
        CHECK(small_float_from_float<mantissa_bits>(zero) == 0);
}

}  // namespace

TEST_CASE("r11g11b10f: every value survives, ties go to even, the range ends at 65024 and 64512") {
    check_small_float<6>(65024);
    check_small_float<5>(64512);
    CHECK(r11g11b10f_from_rgb({1, 2, 4}) == (0x3c0u | 0x400u << 11 | 0x220u << 22));
}

TEST_CASE("rgb9e5: off by at most half a step of the largest channel's mantissa") {
    Floats floats;
    for (int i = 0; i < 100000; ++i) {
        const Vec3f v{floats.next(65408, 34), floats.next(65408, 34), floats.next(65408, 34)};
        const Vec3f back = rgb_from_rgb9e5(rgb9e5_from_rgb(v));
        const float largest = std::max({v.x, v.y, v.z, 0x1p-16f});
        // 2^9 steps below the next power of two above the largest; a channel that rounds up to it doubles the step for
        // the others.
        const float step = std::ldexp(1.0f, std::max(std::ilogb(largest), -16) + 1 - 9),
                    slack = largest > step * 511.4f ? 2 : 1;
        REQUIRE(std::abs(back.x - v.x) <= 0.5f * step * slack);
        REQUIRE(std::abs(back.y - v.y) <= 0.5f * step * slack);
        REQUIRE(std::abs(back.z - v.z) <= 0.5f * step * slack);
    }
}

TEST_CASE("rgb9e5: known words and the ends of the range") {
    CHECK(rgb9e5_from_rgb({0, 0, 0}) == 0);
    CHECK(rgb9e5_from_rgb({1, 0, 0}) == (256u | 16u << 27));
    CHECK(rgb9e5_from_rgb({0.5f, 1, 2}) == (64u | 128u << 9 | 256u << 18 | 17u << 27));
    CHECK(rgb9e5_from_rgb({65408, 65408, 65408}) == 0xffffffffu);
    CHECK(rgb9e5_from_rgb({1e30f, 0, 0}) == (511u | 31u << 27));
    CHECK(rgb9e5_from_rgb({std::numeric_limits<float>::quiet_NaN(), -1, 0}) == 0);
    // 511.6 / 512 rounds up to 2^9, so the exponent goes up by one and the mantissa halves.
    CHECK(rgb9e5_from_rgb({511.6f / 512, 0, 0}) == (256u | 16u << 27));
    CHECK(rgb_from_rgb9e5(1).x == 0x1p-24f);
}

TEST_CASE("rgb9e5: what was decoded encodes to the same value") {
    Floats floats;
    for (int i = 0; i < 20000; ++i) {
        const Vec3f v =
            rgb_from_rgb9e5(rgb9e5_from_rgb({floats.next(65408, 40), floats.next(65408, 40), floats.next(65408, 40)}));
        REQUIRE(rgb_from_rgb9e5(rgb9e5_from_rgb(v)) == v);
    }
}

TEST_CASE("rgbe: off by at most half a step, unbiased, and stable") {
    Floats floats;
    const auto decode = [](std::array<std::uint8_t, 4> p, int c) {
        return double(p[std::size_t(c)]) * std::ldexp(1.0, p[3] - 136);
    };
    double bias = 0;
    for (int i = 0; i < 100000; ++i) {
        // At least 16 steps each, so that errors are uniform over a step.
        const float v[3] = {floats.next(1e5f, 3), floats.next(1e5f, 3), floats.next(1e5f, 3)};
        const auto rgbe = rgbe_from_rgb(v[0], v[1], v[2]);
        const double step = std::ldexp(1.0, rgbe[3] - 136);
        for (int c = 0; c < 3; ++c) {
            REQUIRE(std::abs(decode(rgbe, c) - v[c]) <= 0.5 * step);
            bias += (decode(rgbe, c) - v[c]) / step;
        }
        REQUIRE(std::max({rgbe[0], rgbe[1], rgbe[2]}) >= 128);
        REQUIRE(rgbe_from_rgb(float(decode(rgbe, 0)), float(decode(rgbe, 1)), float(decode(rgbe, 2))) == rgbe);
    }
    // Errors are uniform over one step: the mean of 300000 has a standard deviation of 0.29 / 548 = 5e-4.
    CHECK(std::abs(bias / 300000) < 2.5e-3);
}

TEST_CASE("rgbe: the ends of the range") {
    using Texel = std::array<std::uint8_t, 4>;
    CHECK(rgbe_from_rgb(0, 0, 0) == Texel{0, 0, 0, 0});
    CHECK(rgbe_from_rgb(1, 0.5f, 0) == Texel{128, 64, 0, 129});
    CHECK(rgbe_from_rgb(-1, std::numeric_limits<float>::quiet_NaN(), 0) == Texel{0, 0, 0, 0});
    CHECK(rgbe_from_rgb(255.5f, 0, 0) == Texel{128, 0, 0, 137});  // rounds up to the next exponent
    CHECK(rgbe_from_rgb(1e-45f, 0, 0) == Texel{0, 0, 0, 0});
    CHECK(rgbe_from_rgb(3e38f, 1e38f, 0) == Texel{255, 150, 0, 255});
    CHECK(rgbe_from_rgb(std::numeric_limits<float>::infinity(), 0, 0) == Texel{255, 0, 0, 255});
}
