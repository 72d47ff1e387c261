#include "preview/tonemap.h"

#include "domelight/projection.h"

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
    for (Tonemap method : {Tonemap::none, Tonemap::neutral, Tonemap::agx, Tonemap::agx_punchy}) {
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

TEST_CASE("srgb_encode: the standard's fixed points") {
    CHECK(srgb_encode(0) == 0);
    CHECK(srgb_encode(1) == doctest::Approx(1));
    CHECK(srgb_encode(0.214041f) == doctest::Approx(0.5).epsilon(1e-4));
}

TEST_CASE("log_average_luminance: a constant's is the constant, two halves' the geometric mean, black's 0") {
    ImageF image(64, 32, 3, 2.0f);
    CHECK(log_average_luminance(image.view()) == doctest::Approx(2).epsilon(1e-6));
    for (int y = 16; y < 32; ++y) std::fill_n(image.row(y), 64 * 3, 0.5f);
    CHECK(log_average_luminance(image.view()) == doctest::Approx(1).epsilon(1e-6));
    CHECK(log_average_luminance(ImageF(8, 4, 3).view()) == 0);
}
