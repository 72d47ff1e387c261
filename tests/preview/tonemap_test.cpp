#include "preview/tonemap.h"

#include "domelight/projection/projection.h"

#include "preview/agx_display.h"
#include "test.h"

#include <cmath>
#include <cstdlib>
#include <limits>

using namespace domelight;

TEST_CASE("AgxDisplay: within one code of the plain tone map and transfer function, whatever it is given") {
    std::uint32_t state = 1;
    const auto random = [&] { return float((state = state * 1664525u + 1013904223u) >> 8) / float(1 << 24); };
    const auto check = [](const AgxDisplay& display, const Vec3f& v) {
        const Vec3f exact = tonemap(v * display.exposure(), Tonemap::agx_punchy);
        const std::uint32_t packed = display.code(display.primaries(Texel4::of(v.x, v.y, v.z)));
        const int code[] = {int(packed & 255), int(packed >> 8 & 255), int(packed >> 16)};
        REQUIRE(std::abs(code[0] - to_byte(srgb_encode(exact.x))) <= 1);
        REQUIRE(std::abs(code[1] - to_byte(srgb_encode(exact.y))) <= 1);
        REQUIRE(std::abs(code[2] - to_byte(srgb_encode(exact.z))) <= 1);
    };
    for (const float exposure : {0.5f, 8.0f, 1e-4f}) {
        const AgxDisplay display(exposure);
        for (int i = 0; i < 20000; ++i)
            check(display, {std::exp2(random() * 24 - 14) / exposure, std::exp2(random() * 24 - 14) / exposure,
                            std::exp2(random() * 24 - 14) / exposure});
        const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
        for (const Vec3f& v : {Vec3f{nan, 1, 1}, Vec3f{inf, 0, inf}, Vec3f{-1, -inf, 0}, Vec3f{0, 0, 0}})
            check(display, v);
    }
}

TEST_CASE("tonemap: greys stay grey and rise, colours below the shoulder are PBR Neutral's, anything is in 0..1") {
    for (const auto& [method, name] : EnumNames<Tonemap>::table) {
        INFO(name);
        float before = -1;
        for (int i = -40; i < 30; ++i) {
            const float g = std::exp2(float(i) / 3);
            const Vec3f v = tonemap({g, g, g}, method);
            CHECK(v.x == doctest::Approx(v.y).epsilon(2e-3));
            CHECK(v.z == doctest::Approx(v.y).epsilon(2e-3));
            CHECK(v.y >= before);
            CHECK(v.y <= 1);
            before = v.y;
        }
        const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
        for (const Vec3f& v :
             {tonemap({nan, 1, 1}, method), tonemap({inf, 0, inf}, method), tonemap({-1, -inf, 0}, method)})
            for (float c : {v.x, v.y, v.z}) CHECK((c >= 0 && c <= 1));
    }
    // The specification: above 0.08 the Fresnel offset is 0.04, and nothing else happens below the shoulder.
    const Vec3f v = tonemap({0.5f, 0.3f, 0.2f}, Tonemap::neutral);
    CHECK(v.x == doctest::Approx(0.46));
    CHECK(v.y == doctest::Approx(0.26));
    CHECK(v.z == doctest::Approx(0.16));
}

TEST_CASE("tonemap aces: Hill's published curve, middle grey and white as the ACES transforms have them") {
    // ACES 1.0 RRT + sRGB ODT shows 0.18 as 0.10 of the display's white; the matrices' rows sum to 1, so greys pass
    // through the curve alone: (0.18^2 + 0.0245786 x 0.18 - 9.0537e-5) / (0.983729 x 0.18^2 + 0.432951 x 0.18 +
    // 0.238081).
    CHECK(tonemap({0.18f, 0.18f, 0.18f}, Tonemap::aces).y == doctest::Approx(0.036733611 / 0.347885).epsilon(1e-4));
    CHECK(tonemap({1, 1, 1}, Tonemap::aces).y == doctest::Approx(1.024488 / 1.654761).epsilon(1e-4));
    CHECK(tonemap({100, 100, 100}, Tonemap::aces).y == 1);
    // A saturated blue becomes whiter as it becomes brighter, and so does a saturated red.
    const Vec3f blue = tonemap({0, 0, 20}, Tonemap::aces), red = tonemap({20, 0, 0}, Tonemap::aces);
    CHECK(blue.x > 0.02);
    CHECK(blue.z == 1);
    CHECK(red.y > 0.02);
    // The fit dips below zero at black; the display does not.
    CHECK(tonemap({0, 0, 0}, Tonemap::aces).x == 0);
}

TEST_CASE("tonemap reinhard: luminance by eq. 4, hue as it was, white at its white point") {
    const Vec3f in{0.4f, 0.2f, 0.1f}, out = tonemap(in, Tonemap::reinhard);
    const float l = luminance(in);
    CHECK(luminance(out) == doctest::Approx(l * (1 + l / 16) / (1 + l)));
    CHECK(out.x / out.y == doctest::Approx(2));
    CHECK(out.y / out.z == doctest::Approx(2));
    CHECK(tonemap({4, 4, 4}, Tonemap::reinhard).y == doctest::Approx(1));
    CHECK(tonemap({3.9f, 3.9f, 3.9f}, Tonemap::reinhard).y < 1);
}

TEST_CASE("tonemap gamma22 and none: clipped, and shown by the one curve or the other") {
    const Display gamma{Tonemap::gamma22, 2}, plain{Tonemap::none, 2};
    CHECK(gamma.encoded({0.109f, 1, 0}).x == doctest::Approx(std::pow(0.218, 1 / 2.2)));
    CHECK(gamma.encoded({0.109f, 1, 0}).y == 1);
    CHECK(plain.encoded({0.107021f, 1, 0}).x == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(gamma.rgb8({0, 0.5f, 9})[1] == 255);
}

TEST_CASE("srgb_encode: the standard's fixed points") {
    CHECK(srgb_encode(0) == 0);
    CHECK(srgb_encode(1) == doctest::Approx(1));
    CHECK(srgb_encode(0.214041f) == doctest::Approx(0.5).epsilon(1e-4));
    for (int i = 0; i <= 255; ++i)
        CHECK(srgb_encode(srgb_decode(float(i) / 255)) == doctest::Approx(i / 255.0).epsilon(1e-5));
}

TEST_CASE("log_average_luminance: a constant's is the constant, two halves' the geometric mean, black's 0") {
    ImageF image(64, 32, 3, 2.0f);
    CHECK(log_average_luminance(image.view()) == doctest::Approx(2).epsilon(1e-6));
    for (int y = 16; y < 32; ++y) std::fill_n(image.row(y), 64 * 3, 0.5f);
    CHECK(log_average_luminance(image.view()) == doctest::Approx(1).epsilon(1e-6));
    CHECK(log_average_luminance(ImageF(8, 4, 3).view()) == 0);
}
