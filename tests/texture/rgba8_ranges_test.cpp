#include "texture/texel/rgba8_ranges.h"

#include "test.h"

#include <algorithm>
#include <cmath>

using namespace domelight;

namespace {

/// One of the three encodings, with its decoder in double as the engines define it.
struct Form {
    const char* name;
    Rgba8 (*encode)(const Vec3f&);
    Vec3f (*decode)(const Rgba8&);
    double (*value)(double colour, double scale);  ///< shares of 255
    float max;
};

const Form k_forms[] = {
    {"rgbm", rgbm_from_rgb, rgb_from_rgbm, [](double c, double a) { return std::pow(8 * a * c, 2); }, k_rgbm_max},
    {"rgbp", rgbp_from_rgb, rgb_from_rgbp, [](double c, double a) { return std::pow((8 - 7 * a) * c, 2); }, k_rgbp_max},
    {"rgbd", rgbd_from_rgb, rgb_from_rgbd, [](double c, double a) { return std::pow(c, 2.2) / a; }, k_rgbd_max},
};

float noise(std::uint32_t& state) {
    state = state * 1664525u + 1013904223u;
    return float(state >> 8) * 0x1p-24f;
}

double distance(const Vec3f& a, const Vec3f& b) {
    return length(a - b);
}

/// The least difference between a value and what any bytes decode to.
double best_distance(const Form& form, const Vec3f& rgb) {
    const float channel[3] = {rgb.x, rgb.y, rgb.z};
    double best = 1e30;
    for (int scale = 1; scale < 256; ++scale) {
        double sum = 0;
        for (const float v : channel) {
            double least = 1e30;
            for (int c = 0; c < 256; ++c) least = std::min(least, std::abs(form.value(c / 255.0, scale / 255.0) - v));
            sum += least * least;
        }
        best = std::min(best, std::sqrt(sum));
    }
    return best;
}

}  // namespace

TEST_CASE("rgbm, rgbp, rgbd: decoders are the engines' formulas") {
    for (const Form& form : k_forms)
        for (int scale = 1; scale < 256; scale += 3)
            for (int c = 0; c < 256; c += 5) {
                const Vec3f v = form.decode({std::uint8_t(c), std::uint8_t(255 - c), 255, std::uint8_t(scale)});
                CAPTURE(form.name);
                CHECK(v.x == doctest::Approx(form.value(c / 255.0, scale / 255.0)).epsilon(1e-5));
                CHECK(v.y == doctest::Approx(form.value(1 - c / 255.0, scale / 255.0)).epsilon(1e-5));
                CHECK(v.z == doctest::Approx(form.value(1, scale / 255.0)).epsilon(1e-5));
            }
}

TEST_CASE("rgbm, rgbp, rgbd: black, the largest value and one come back") {
    for (const Form& form : k_forms) {
        CAPTURE(form.name);
        CHECK(form.decode(form.encode({0, 0, 0})) == Vec3f{0, 0, 0});
        const float m = form.max;
        const Vec3f top = form.decode(form.encode({m, m, m}));
        CHECK(top.x == doctest::Approx(m).epsilon(1e-5));
        const Vec3f one = form.decode(form.encode({1, 1, 1}));
        CHECK(one.y == doctest::Approx(1).epsilon(2e-3));
        for (int i = 0; i < 256; ++i) form.decode({255, 0, 1, std::uint8_t(i)});  // any bytes
        CHECK(std::isfinite(form.decode({255, 255, 255, 0}).x));
    }
}

TEST_CASE("rgbm, rgbp, rgbd: close to the nearest that any bytes decode to, and within a known error") {
    for (const Form& form : k_forms) {
        CAPTURE(form.name);
        std::uint32_t state = 11;
        double ours = 0, best = 0;
        for (int i = 0; i < 60; ++i) {
            // Over all the range: 2^-6 to the maximum.
            const float brightness = std::exp2(-6 + noise(state) * (std::log2(form.max) + 6));
            const Vec3f rgb{brightness * noise(state), brightness, brightness * noise(state)};
            const Vec3f back = form.decode(form.encode(rgb));
            const double d = distance(rgb, back), b = best_distance(form, rgb);
            CHECK(d >= b * 0.999);
            if (brightness > 1) CHECK(d <= 0.01 * brightness);
            ours += d / brightness;
            best += b / brightness;
        }
        // Eight scales of the 255: most of the way from one to all of them.
        CHECK(ours < 2.5 * best);
    }
}

TEST_CASE("rgbm, rgbp, rgbd: doubling steadily never makes anything darker") {
    for (const Form& form : k_forms) {
        float before = 0;
        for (float v = 0.001f; v < form.max; v *= 1.05f) {
            const float now = form.decode(form.encode({v, v, v})).x;
            CHECK(now >= before * 0.999f);
            before = now;
        }
    }
}
