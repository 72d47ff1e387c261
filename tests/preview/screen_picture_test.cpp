#include "preview/screen_picture.h"

#include "test.h"

#include <cmath>
#include <limits>

using namespace domelight;

namespace {

ImageF filled(int width, int height, float value) {
    return ImageF(width, height, 3, value);
}

}  // namespace

TEST_CASE("automatic_ev: a grey of 0.18 needs no exposure, and twice as much one stop less") {
    CHECK(automatic_ev(filled(4, 3, 0.18f)) == doctest::Approx(0).epsilon(1e-6));
    CHECK(automatic_ev(filled(4, 3, 0.36f)) == doctest::Approx(-1).epsilon(1e-6));
    CHECK(automatic_ev(filled(4, 3, 0)) == 0);
}

TEST_CASE("automatic_ev: pixels count by their weight, and those that are not finite do not") {
    ImageF rgb = filled(4, 1, 0.18f), weights(4, 1, 1, 1.0f);
    for (int c = 0; c < 3; ++c) rgb.at(0, 0)[c] = 3, rgb.at(1, 0)[c] = std::numeric_limits<float>::infinity();
    *weights.at(0, 0) = 0;
    CHECK(automatic_ev(rgb, weights) == doctest::Approx(0).epsilon(1e-6));
    CHECK(automatic_ev(rgb) < -1);
    CHECK(std::isfinite(automatic_ev(rgb)));
}

TEST_CASE("automatic_ev: what is multiplied with its opacity counts as bright as it was before") {
    ImageF rgb = filled(2, 1, 0.18f), opacity(2, 1, 1, 1.0f);
    *opacity.at(1, 0) = 0.5f;
    for (int c = 0; c < 3; ++c) rgb.at(1, 0)[c] = 0.09f;
    CHECK(automatic_ev(rgb, opacity, true) == doctest::Approx(0).epsilon(1e-6));
    CHECK(automatic_ev(rgb, opacity, false) > 0.1);
}

TEST_CASE("screen_picture: opacity becomes a fourth channel, and colours are divided by it") {
    ImageF rgb = filled(2, 1, 0.25f), opacity(2, 1, 1, 1.0f);
    *opacity.at(1, 0) = 0.5f;
    const Display display{Tonemap::none, 1};
    const auto opaque = screen_picture(rgb, {}, display), transparent = screen_picture(rgb, opacity, display);
    CHECK(opaque.channels() == 3);
    REQUIRE(transparent.channels() == 4);
    CHECK(transparent.at(0, 0)[0] == to_byte(srgb_encode(0.25f)));
    CHECK(transparent.at(1, 0)[0] == to_byte(srgb_encode(0.5f)));
    CHECK(transparent.at(0, 0)[3] == 255);
    CHECK(transparent.at(1, 0)[3] == 128);
}
