#include "texture/texel/half.h"

#include "test.h"

#include <Imath/half.h>

#include <cmath>
#include <limits>

using namespace domelight;

TEST_CASE("half: every half survives the way to float and back") {
    for (std::uint32_t h = 0; h < 65536; ++h) {
        const float f = float_from_half(std::uint16_t(h));
        if (std::isnan(f))
            CHECK((half_from_float(f) & 0x7fffu) > 0x7c00u);
        else
            REQUIRE(half_from_float(f) == h);
    }
}

TEST_CASE("half: rounds to nearest, ties to even") {
    // Between any two neighbours: below the middle down, above it up, the middle to the even one.
    for (std::uint32_t h = 0; h < 0x7bff; ++h) {
        const double low = float_from_half(std::uint16_t(h)), high = float_from_half(std::uint16_t(h + 1));
        const float middle = float((low + high) / 2);  // exact: one more bit
        REQUIRE(half_from_float(middle) == (h % 2 ? h + 1 : h));
        REQUIRE(half_from_float(std::nextafter(middle, 0.0f)) == h);
        REQUIRE(half_from_float(std::nextafter(middle, 1e9f)) == h + 1);
        REQUIRE(half_from_float(-middle) == (0x8000u | (h % 2 ? h + 1 : h)));
    }
}

TEST_CASE("half: the ends of the range") {
    CHECK(half_from_float(65504) == 0x7bff);
    CHECK(half_from_float(65519.996f) == 0x7bff);
    CHECK(half_from_float(65520) == 0x7c00);
    CHECK(half_from_float(std::numeric_limits<float>::infinity()) == 0x7c00);
    CHECK(half_from_float(0x1p-24f) == 1);
    CHECK(half_from_float(0x1p-25f) == 0);
    CHECK(half_from_float(-0.0f) == 0x8000);
}

TEST_CASE("half: agrees with Imath") {
    std::uint32_t state = 1;
    for (int i = 0; i < 200000; ++i) {
        state = state * 1664525u + 1013904223u;
        const float f = std::bit_cast<float>(state);
        if (std::isnan(f)) continue;
        REQUIRE(half_from_float(f) == Imath::half(f).bits());
    }
}
