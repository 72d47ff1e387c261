#include "domelight/compare/metrics.h"

#include "test.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

using namespace domelight;

namespace {

constexpr int k_width = 96, k_height = 64;

/// The pictures of flip_reference.py.
struct Pictures {
    Image<double> waves{k_width, k_height, 3}, noise{k_width, k_height, 3};
    Pictures() {
        std::uint32_t state = 1;
        for (int y = 0; y < k_height; ++y)
            for (int x = 0; x < k_width; ++x)
                for (int c = 0; c < 3; ++c) {
                    waves.at(x, y)[c] =
                        0.5 + 0.4 * std::sin(0.31 * x + 0.17 * y + c) * std::cos(0.07 * x * (c + 1) - 0.05 * y);
                    state = 1664525u * state + 1013904223u;
                    noise.at(x, y)[c] = state / 4294967296.0;
                }
    }
    template <typename F>
    ImageF make(F f) const {
        ImageF out(k_width, k_height, 3);
        for (int y = 0; y < k_height; ++y)
            for (int x = 0; x < k_width; ++x)
                for (int c = 0; c < 3; ++c) out.at(x, y)[c] = float(f(waves.at(x, y)[c], noise.at(x, y)[c], x, y));
        return out;
    }
};

bool in_spot(int x, int y) {
    return x >= 40 && x < 43 && y >= 30 && y < 33;
}

ImageF noisy(const ImageF& image, double sigma, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal(0, sigma);
    ImageF out = image;
    for (float& v : out.pixels()) v = float(v + normal(generator));
    return out;
}

}  // namespace

TEST_SUITE("render") {
    TEST_CASE("metrics: constant images have the errors that the definitions give") {
        const double a = 0.5, b = 2;
        const Errors e = compare_images(ImageF(40, 30, 3, float(a)).view(), ImageF(40, 30, 3, float(b)).view());
        CHECK(e.rmse == doctest::Approx(1.5));
        CHECK(e.relative_rmse == doctest::Approx(0.75));
        const double ta = a / (1 + a), tb = b / (1 + b);
        CHECK(e.tone_mapped_rmse == doctest::Approx(tb - ta).epsilon(1e-6));
        CHECK(e.mean_ratio == doctest::Approx(0.25));
        CHECK(e.largest == doctest::Approx(1.5));
        CHECK(e.psnr == doctest::Approx(-20 * std::log10(tb - ta)).epsilon(1e-6));
        // Without structure only the luminance term is left: (2 a b + C1) / (a^2 + b^2 + C1).
        CHECK(e.ssim == doctest::Approx((2 * ta * tb + 1e-4) / (ta * ta + tb * tb + 1e-4)).epsilon(1e-5));
        CHECK(e.pixels == 1200);
    }

    TEST_CASE("metrics: equal images have no error, and black ones are no division by zero") {
        const ImageF image = Pictures().make([](double w, double, int, int) { return 3 * w; });
        const Errors e = compare_images(image.view(), image.view());
        CHECK(e.rmse == 0);
        CHECK(e.relative_rmse == 0);
        CHECK(e.mean_ratio == 1);
        CHECK(std::isinf(e.psnr));
        CHECK(e.ssim == doctest::Approx(1).epsilon(1e-6));
        const ImageF black(4, 4, 3), grey(4, 4, 3, 0.5f);
        CHECK(compare_images(black.view(), black.view()).relative_rmse == 0);
        CHECK(compare_images(black.view(), black.view()).mean_ratio == 1);
        CHECK(std::isinf(compare_images(grey.view(), black.view()).relative_rmse));
    }

    TEST_CASE("metrics: one wrong pixel among n gives |d| / sqrt(n) and is the largest") {
        ImageF reference(20, 10, 3, 1.0f), test = reference;
        for (int c = 0; c < 3; ++c) test.at(7, 3)[c] = 5;
        const Errors e = compare_images(test.view(), reference.view());
        CHECK(e.rmse == doctest::Approx(4 / std::sqrt(200.0)));
        CHECK(e.largest == doctest::Approx(4));
        ImageF mask(20, 10, 1, 1.0f);
        *mask.at(7, 3) = 0;
        const Errors without = compare_images(test.view(), reference.view(), mask.view());
        CHECK(without.rmse == 0);
        CHECK(without.pixels == 199);
        CHECK(without.ssim == doctest::Approx(1));  // windows leave out what is behind the mask
        ImageF none(20, 10, 1);
        CHECK(compare_images(test.view(), reference.view(), none.view()).pixels == 0);
    }

    TEST_CASE("ssim: an image against its negative about the mean has the closed form of anticorrelation") {
        // A checkerboard of 0.5 +- d, tone mapped values: within any window of full size, mean ~ 0.5 and covariance =
        // -variance.
        const double d = 0.2;
        ImageF a(64, 64, 3), b(64, 64, 3);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                for (int c = 0; c < 3; ++c) {
                    const double s = (x + y) % 2 ? d : -d, up = 0.5 + s, down = 0.5 - s;
                    a.at(x, y)[c] = float(up / (1 - up));  // inverse of L / (1 + L)
                    b.at(x, y)[c] = float(down / (1 - down));
                }
        const ImageF map = ssim(a.view(), b.view());
        const double expected = (-2 * d * d + 9e-4) / (2 * d * d + 9e-4);
        // The alternating sum of the Gaussian is exp(−π² σ²) = 2e-10; cutting it off at 5 pixels leaves 1e-3 of the
        // mean.
        CHECK(*map.at(32, 32) == doctest::Approx(expected).epsilon(0.001));
    }

    TEST_CASE("metrics: figures have the same bits on one thread and on three") {
        const Pictures p;
        const ImageF a = p.make([](double w, double n, int, int) { return w * (0.5 + n); }),
                     b = p.make([](double w, double, int, int) { return w; });
        const Errors one = compare_images(a.view(), b.view(), {}, 1), three = compare_images(a.view(), b.view(), {}, 3);
        CHECK(std::memcmp(&one, &three, sizeof one) == 0);
        const HdrFlip f = hdr_flip(a.view(), b.view(), {}, 1), g = hdr_flip(a.view(), b.view(), {}, 3);
        CHECK(std::equal(f.error.pixels().begin(), f.error.pixels().end(), g.error.pixels().begin()));
    }

    TEST_CASE("compare_noisy: noise of the stated variance gives chi2 1, and a bias shows") {
        const ImageF truth(120, 100, 3, 1.0f), variance(120, 100, 3, 0.04f);
        const ImageF test = noisy(truth, 0.2, 1), reference = noisy(truth, 0.2, 2);
        const NoiseSummary n = compare_noisy(test.view(), reference.view(), variance.view(), variance.view());
        CHECK(n.values == 36000);
        // Standard errors over 36 000 values: chi2 √(2 / n) = 0.0075, share 0.0011, mean z 0.0053; four of them
        // allowed.
        CHECK(std::abs(n.chi2 - 1) < 0.03);
        CHECK(std::abs(n.share_above_2 - 0.0455) < 0.0044);
        CHECK(std::abs(n.mean_z) < 0.021);
        CHECK(std::abs(n.total_z) < 4);
        CHECK(n.ratio_low < n.mean_ratio);
        // sd of the ratio of means = √2 · 0.2 / √36000 = 0.00149
        const double expected = 2 * 1.96 * std::sqrt(2.0) * 0.2 / std::sqrt(36000.0);
        CHECK((n.ratio_high - n.ratio_low) / expected == doctest::Approx(1).epsilon(0.01));

        ImageF biased = test;
        for (float& v : biased.pixels()) v += 0.02f;
        CHECK(compare_noisy(biased.view(), reference.view(), variance.view(), variance.view()).total_z > 8);
        const NoiseSummary exact = compare_noisy(test.view(), truth.view(), {}, {});
        CHECK(exact.values == 0);
        CHECK(exact.without_noise > 35000);
    }

    TEST_CASE("find_bad_pixels: counts and places what is not finite, outside the mask not") {
        ImageF image(8, 8, 3, 1.0f);
        image.at(5, 2)[1] = std::numeric_limits<float>::quiet_NaN();
        image.at(1, 6)[0] = std::numeric_limits<float>::infinity();
        const BadPixels bad = find_bad_pixels(image.view());
        CHECK(bad.count == 2);
        CHECK(bad.x == 5);
        CHECK(bad.y == 2);
        ImageF mask(8, 8, 1, 1.0f);
        *mask.at(5, 2) = 0;
        CHECK(find_bad_pixels(image.view(), mask.view()).count == 1);
    }

    TEST_CASE("flip: agrees with the authors' program on its own pictures") {
        const Pictures p;
        const auto clip = [](double v) { return std::clamp(v, 0.0, 1.0); };
        const ImageF reference = p.make([&](double w, double, int, int) { return clip(w); });
        const ImageF test = p.make([&](double w, double n, int, int) { return clip(w + 0.3 * (n - 0.5)); });
        struct Known {
            double ppd, mean, at_20_10, at_95_63;
        };
        // Printed by flip_reference.py; both programs compute in floats, which leaves about 1e-6 of a mean.
        for (const Known& k :
             {Known{67.0206, 0.168433130, 0.1443399, 0.3725525}, Known{30, 0.309566230, 0.3809222, 0.5039243},
              Known{120, 0.123588473, 0.1228113, 0.3485322}}) {
            const ImageF error = flip(test.view(), reference.view(), {k.ppd});
            CAPTURE(k.ppd);
            CHECK(std::abs(mean_of(error.view()) - k.mean) < 1e-5);
            CHECK(std::abs(*error.at(20, 10) - k.at_20_10) < 1e-4);
            CHECK(std::abs(*error.at(95, 63) - k.at_95_63) < 1e-4);
        }
    }

    TEST_CASE("hdr_flip: agrees with the authors' program, its exposures too") {
        const Pictures p;
        const auto base = [](double w) { return 8 * w * w * w * w + 0.02; };
        const ImageF reference =
            p.make([&](double w, double, int x, int y) { return base(w) * (in_spot(x, y) ? 200 : 1); });
        const ImageF test = p.make(
            [&](double w, double n, int x, int y) { return base(w) * (0.7 + 0.6 * n) * (in_spot(x, y) ? 150 : 1); });
        const HdrFlip f = hdr_flip(test.view(), reference.view());
        CHECK(f.count == 8);
        CHECK(std::abs(f.start - -6.309603691) < 1e-5);
        CHECK(std::abs(f.stop - 1.579748034) < 1e-5);
        CHECK(std::abs(mean_of(f.error.view()) - 0.108972766) < 1e-5);
        CHECK(std::abs(*f.error.at(20, 10) - 0.0635515) < 1e-4);
        CHECK(std::abs(*f.error.at(41, 31) - 0.2246427) < 1e-4);
    }

    TEST_CASE("flip: nothing differs from itself, and black from white nearly as much as can be") {
        const ImageF black(48, 48, 3), white(48, 48, 3, 1.0f);
        CHECK(mean_of(flip(white.view(), white.view()).view()) == 0);
        // The authors' program says 0.96739197: HyAB's largest is that of green against blue.
        CHECK(std::abs(mean_of(flip(black.view(), white.view()).view()) - 0.96739197) < 1e-5);
        CHECK(mean_of(hdr_flip(black.view(), black.view()).error.view()) == 0);
    }
}
