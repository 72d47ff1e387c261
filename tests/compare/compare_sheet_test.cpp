#include "domelight/compare/compare_sheet.h"

#include "preview/colour_map.h"
#include "test.h"

#include <cmath>
#include <limits>

using namespace domelight;

namespace {

/// CIE lightness L* of an sRGB colour.
double lightness(Colour8 c) {
    const auto linear = [](std::uint8_t b) {
        const double v = b / 255.0;
        return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    const double y = 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
    return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

}  // namespace

TEST_CASE("heat_colour: lightness rises all the way, so a grey print keeps the order") {
    double before = lightness(heat_colour(0));
    for (int i = 1; i <= 32; ++i) {
        const double now = lightness(heat_colour(float(i) / 32));
        CHECK(now > before);
        before = now;
    }
    CHECK(lightness(heat_colour(0)) < 5);
    CHECK(lightness(heat_colour(1)) > 93);
    CHECK(lightness(heat_colour(std::numeric_limits<float>::quiet_NaN())) < 5);
    CHECK(lightness(heat_colour(7)) > 93);
}

TEST_CASE("signed_colour: zero is light, both ends equally dark, blue below and red above") {
    const Colour8 low = signed_colour(-1), zero = signed_colour(0), high = signed_colour(1);
    CHECK(lightness(zero) > 93);
    CHECK(std::abs(lightness(low) - lightness(high)) < 6);
    CHECK(low.b > low.r + 50);
    CHECK(high.r > high.b + 50);
}

TEST_CASE("scale_for: the next of 1, 2, 5 above nearly all values; a few fireflies do not stretch it") {
    ImageF values(100, 10, 1, 0.3f);
    CHECK(scale_for(values.view()) == doctest::Approx(0.5));
    *values.at(3, 3) = 1000;
    CHECK(scale_for(values.view()) == doctest::Approx(0.5));
    CHECK(scale_for(ImageF(4, 4, 1).view()) == 1);
    CHECK(scale_for(ImageF(4, 4, 1, -0.07f).view()) == doctest::Approx(0.1));
}

TEST_CASE("heat_picture: what the mask leaves out is grey, one pixel's colour is where the pixel is") {
    ImageF values(200, 50, 1), mask(200, 50, 1, 1.0f);
    *values.at(20, 10) = 1;
    *mask.at(100, 30) = 0;
    const HeatMap map{values.view(), "title", 1, false};
    const Image<std::uint8_t> picture = heat_picture(map, mask.view());
    CHECK(picture.width() == 400);  // enlarged by two
    const auto at = [&](int x, int y) {
        const std::uint8_t* p = picture.at(x, y);
        return Colour8{p[0], p[1], p[2]};
    };
    CHECK(lightness(at(2 * 20, 34 + 2 * 10)) > 93);
    CHECK(lightness(at(2 * 22, 34 + 2 * 10)) < 5);
    const Colour8 masked = at(2 * 100, 34 + 2 * 30);
    CHECK(std::abs(int(masked.r) - int(masked.b)) < 12);
    CHECK(lightness(masked) > 15);
}
