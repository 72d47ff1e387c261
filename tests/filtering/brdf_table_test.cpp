#include "domelight/filtering/brdf/brdf_table.h"

#include "domelight/base/vec.h"

#include "base/gauss_legendre.h"
#include "filtering/brdf/brdf_quadrature.h"
#include "test.h"

#include <cmath>
#include <random>

using namespace domelight;

namespace {

/// Texels of a 128^2 table: the corners, the edges' middles and some at random.
std::vector<std::pair<int, int>> texels() {
    std::vector<std::pair<int, int>> list = {{0, 0},  {127, 0}, {0, 127},  {127, 127}, {0, 15},
                                             {0, 24}, {64, 0},  {64, 127}, {127, 64},  {1, 1}};
    std::mt19937 generator(3);
    for (int i = 0; i < 40; ++i) list.emplace_back(int(generator() % 128), int(generator() % 128));
    return list;
}

/// ∫ f NdotL dω over the hemisphere of light directions (μ, φ), without half vectors. For α that a plain grid resolves.
BrdfTerms over_light_directions(double NdotV, double alpha, BrdfG g) {
    const GaussLegendre& rule = gauss_legendre(400);
    const double s_v = std::sqrt(1 - NdotV * NdotV);
    BrdfTerms sum;
    for (std::size_t i = 0; i < rule.x.size(); ++i)
        for (std::size_t j = 0; j < rule.x.size(); ++j) {
            // This substitution removes the square roots at both ends; μ = sin² (π x / 4) would do so as well.
            const double x = (1 + rule.x[i]) / 2, mu = x * x * (3 - 2 * x), dmu = 6 * x * (1 - x) * rule.w[i] / 2;
            const double phi = k_pi * (1 + rule.x[j]) / 2, s_l = std::sqrt(1 - mu * mu);
            const double v_l = NdotV * mu + s_v * s_l * std::cos(phi), length2 = 2 + 2 * v_l;
            const double NdotH = (NdotV + mu) / std::sqrt(length2), VdotH = std::sqrt((1 + v_l) / 2);
            const double d = NdotH * NdotH * (alpha * alpha - 1) + 1, D = alpha * alpha / (k_pi * d * d);
            const double f = D * brdf_visibility(mu, NdotV, alpha, g) * mu * 2 * (k_pi / 2) * rule.w[j] * dmu;
            const double fresnel = std::pow(1 - VdotH, 5);
            sum.scale += f * (1 - fresnel);
            sum.bias += f * fresnel;
        }
    return sum;
}

}  // namespace

TEST_CASE("brdf_table: the default agrees with a far finer quadrature to 1e-5, the corners included") {
    const ImageF& table = brdf_table_default();
    REQUIRE(table.width() == 128);
    REQUIRE(table.height() == 128);
    for (auto [x, y] : texels()) {
        const double NdotV = (x + 0.5) / 128, roughness = (y + 0.5) / 128, alpha = roughness * roughness;
        const BrdfTerms truth = integrate_brdf(NdotV, alpha, BrdfG::correlated, {64, 300});
        CHECK_MESSAGE(std::abs(table.at(x, y)[0] - truth.scale) < 1e-5, x, ", ", y);
        CHECK_MESSAGE(std::abs(table.at(x, y)[1] - truth.bias) < 1e-5, x, ", ", y);
        CHECK_MESSAGE(std::abs(table.at(x, y)[2] - integrate_sheen(NdotV, alpha, 128)) < 1e-5, x, ", ", y);
    }
}

TEST_CASE("brdf_table: each G is the one its name says") {
    // α = NdotL = NdotV = 1/2: √(α^2 + (1 - α^2) c^2) = √7 / 4.
    const double root = std::sqrt(7.0) / 4;
    CHECK(brdf_visibility(0.5, 0.5, 0.5, BrdfG::correlated) == doctest::Approx(0.5 / root));
    CHECK(brdf_visibility(0.5, 0.5, 0.5, BrdfG::smith) == doctest::Approx(1 / ((0.5 + root) * (0.5 + root))));
    CHECK(brdf_visibility(0.5, 0.5, 0.5, BrdfG::karis) ==
          doctest::Approx(0.64));  // k = 1/4: G1 = 4/5, over 4 NdotL NdotV = 1
}

TEST_CASE("brdf_table: half vectors and light directions integrate to the same, for each G") {
    for (BrdfG g : {BrdfG::correlated, BrdfG::smith, BrdfG::karis})
        for (double NdotV : {0.1, 0.5, 0.95})
            for (double alpha : {0.3, 0.6, 1.0}) {
                const BrdfTerms a = integrate_brdf(NdotV, alpha, g), b = over_light_directions(NdotV, alpha, g);
                CHECK(a.scale == doctest::Approx(b.scale).epsilon(2e-5));  // the quadrature's 1e-5
                CHECK(std::abs(a.bias - b.bias) < 1e-5);
            }
}

TEST_CASE("brdf_table: closed forms: a mirror reflects all, a rough lobe seen from above, never more than it gets") {
    // α -> 0: scale + bias = 1 and bias = (1 - NdotV)^5.
    for (double NdotV : {0.2, 0.6, 1.0}) {
        const BrdfTerms mirror = integrate_brdf(NdotV, 1e-5, BrdfG::correlated);
        CHECK(mirror.scale + mirror.bias == doctest::Approx(1).epsilon(1e-5));
        CHECK(mirror.bias == doctest::Approx(std::pow(1 - NdotV, 5)).epsilon(1e-3));
    }
    // α = 1, NdotV = 1: D = 1 / π, V = 1 / 2 / (c + 1): 2π ∫ c / (2π (1 + c)) dc = 1 − log 2.
    const BrdfTerms rough = integrate_brdf(1, 1, BrdfG::correlated);
    CHECK(rough.scale + rough.bias == doctest::Approx(1 - std::log(2.0)).epsilon(1e-6));
    const ImageF& table = brdf_table_default();
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            const float* p = table.at(x, y);
            REQUIRE(p[0] + p[1] <= 1.00001f);
            REQUIRE(p[0] > 0);
            REQUIRE(p[1] >= 0);
            REQUIRE(p[2] >= 0);
        }
}

TEST_CASE("brdf_table: the sheen seen from straight above, in closed form") {
    // NdotV = 1: θ_h = θ_l / 2, V = 1/4; with p = 1 / 2 α: ∫ D c / 4 = (2 + 2p) / 4 · 2^-p ∫ c (1 − c)^p
    // dc, and that integral is 1 / ((p + 1) (p + 2)).
    for (double alpha : {1.0, 0.5, 0.1}) {
        const double p = 0.5 / alpha;
        CHECK(integrate_sheen(1, alpha) == doctest::Approx(std::pow(2, -p) / (2 * (p + 2))).epsilon(1e-5));
    }
}

TEST_CASE("brdf_table: other sizes and G, the multiple-scattering form, any number of threads") {
    const ImageF small = brdf_table({16, BrdfG::correlated, 1}), three = brdf_table({16, BrdfG::correlated, 3});
    CHECK(std::equal(small.pixels().begin(), small.pixels().end(), three.pixels().begin()));
    // 128 / 16 = 8: the centre of a small table's texel is the common corner of the middle four of 8 x 8 large texels.
    const ImageF& table = brdf_table_default();
    const double mean = (table.at(59, 67)[0] + table.at(60, 67)[0] + table.at(59, 68)[0] + table.at(60, 68)[0]) / 4.0;
    CHECK(small.at(7, 8)[0] == doctest::Approx(mean).epsilon(1e-3));

    const ImageF karis = brdf_table({128, BrdfG::karis, 0});
    const BrdfTerms truth = integrate_brdf(32.5 / 128, std::pow(70.5 / 128, 2), BrdfG::karis, {64, 300});
    CHECK(std::abs(karis.at(32, 70)[0] - truth.scale) < 1e-5);
    CHECK(karis.at(32, 70)[2] == table.at(32, 70)[2]);

    const ImageF multiple = brdf_table_multiscatter(table);
    CHECK(multiple.at(5, 90)[0] == table.at(5, 90)[1]);
    CHECK(multiple.at(5, 90)[1] == table.at(5, 90)[0] + table.at(5, 90)[1]);
    CHECK(multiple.at(5, 90)[2] == table.at(5, 90)[2]);
}

TEST_CASE("brdf_table: the courses' Monte Carlo comes within its noise") {
    const ImageF exact = brdf_table({16, BrdfG::karis, 0}),
                 estimate = brdf_table_montecarlo({16, BrdfG::karis, 0}, {.count = 4096});
    double worst = 0, sum = 0;
    for (int y = 2; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            for (int c = 0; c < 3; ++c) {
                const double e = std::abs(exact.at(x, y)[c] - estimate.at(x, y)[c]) / std::max(0.1f, exact.at(x, y)[c]);
                worst = std::max(worst, e);
                sum += e;
            }
    CHECK(worst < 0.1);  // at grazing angles, where few samples carry nearly all of the value
    CHECK(sum / (14 * 16 * 3) < 2e-3);
}
