#include "domelight/sampling/microfacet.h"

#include "domelight/base/frame.h"
#include "domelight/sampling/sequences.h"

#include "sampling/hemisphere_quadrature.h"
#include "test.h"

#include <cmath>

using namespace domelight;
using namespace domelight::test;

namespace {

constexpr double k_alphas[]{0.03, 0.2, 0.6, 1};

template <typename G>
double over_hemisphere(const G& g) {
    double sum = 0;
    for (int i = 0; i < 18 * 6; ++i) sum += integrate(hemisphere_patch(i, 18, 6), g, 1e-8);
    return sum;
}

}  // namespace

TEST_CASE("microfacet: the distributions' projected areas are 1") {
    for (double alpha : k_alphas) {
        CHECK(over_hemisphere([&](const Vec3d& H) { return ggx_d(H, alpha) * H.z; }) ==
              doctest::Approx(1).epsilon(1e-6));
        const auto charlie = [&](const Vec3d& H) { return charlie_d(H.x * H.x + H.y * H.y, alpha) * H.z; };
        CHECK(over_hemisphere(charlie) == doctest::Approx(1).epsilon(1e-6));
    }
}

TEST_CASE("microfacet: GGX in closed form") {
    for (double alpha : k_alphas) {
        CHECK(ggx_d(Vec3d{0, 0, 1}, alpha) == doctest::Approx(1 / (k_pi * alpha * alpha)));
        // Walter et al. 2007, eq. 33 as printed, with the tangent; and the length of H does not matter
        const Vec3d H = hemisphere_direction(0.4, 1);
        const double tan2 = std::pow(std::tan(0.4), 2), a2 = alpha * alpha;
        const double printed = a2 / (k_pi * std::pow(std::cos(0.4), 4) * std::pow(a2 + tan2, 2));
        CHECK(ggx_d(H, alpha) == doctest::Approx(printed));
        CHECK(ggx_d(H * 0.01, alpha) == doctest::Approx(printed));
        // Smith: 1 / (1 + Lambda), and with the heights correlated 1 / (1 + Lambda_v + Lambda_l) (Heitz 2014, eqs. 72,
        // 99)
        const auto lambda = [&](double c) { return (-1 + std::sqrt(1 + a2 * (1 / (c * c) - 1))) / 2; };
        for (double v : {0.05, 0.5, 1.0}) {
            CHECK(ggx_g1(v, alpha) == doctest::Approx(1 / (1 + lambda(v))));
            for (double l : {0.1, 0.9})
                CHECK(ggx_visibility(l, v, alpha) == doctest::Approx(1 / (1 + lambda(v) + lambda(l)) / (4 * l * v)));
        }
    }
    CHECK(ggx_d(hemisphere_direction(0.9, 0), 1.0) == doctest::Approx(1 / k_pi));
    CHECK(ggx_g1(0.5, 1.0) == doctest::Approx(2.0 / 3));
}

TEST_CASE("microfacet: masking is what makes visible microfacets fill the view (Heitz 2014, eq. 14)") {
    for (double alpha : k_alphas)
        for (double NdotV : {0.2, 0.7, 1.0}) {
            const Vec3d V{std::sqrt(1 - NdotV * NdotV), 0, NdotV};
            const double visible = over_hemisphere(
                [&](const Vec3d& H) { return ggx_g1(NdotV, alpha) * std::max(0.0, dot(V, H)) * ggx_d(H, alpha); });
            CHECK(visible == doctest::Approx(NdotV).epsilon(1e-5));
        }
}

TEST_CASE("microfacet: Schlick's Fresnel and the sheen's visibility by hand") {
    CHECK(schlick_weight(1.0) == 0);
    CHECK(schlick_weight(0.0) == 1);
    CHECK(schlick_weight(0.5) == 1.0 / 32);
    CHECK(schlick_weight(1.0f + 1e-6f) == 0);
    const Vec3f f = fresnel_schlick(0.5f, {0.04f, 0.5f, 1}, {1, 0.5f, 1});
    CHECK(f.x == doctest::Approx(0.04 + 0.96 / 32));
    CHECK(f.y == 0.5f);
    CHECK(f.z == 1.0f);
    CHECK(sheen_visibility(0.5, 0.5) == doctest::Approx(1.0 / 3));
    CHECK(sheen_visibility(1.0, 0.3) == doctest::Approx(0.25));
    CHECK(charlie_d(1.0, 0.25) == doctest::Approx(3 / k_pi));
}

TEST_CASE("microfacet: the caps' bound") {
    CHECK(ggx_cap_bound({0, 0, 1}, 1) == 0);
    CHECK(ggx_cap_bound({1, 0, 0}, 0.5f) == doctest::Approx(0.75));
    CHECK(ggx_cap_bound({0, 0, 1}, 0.5f) == doctest::Approx(0.75 / 1.25));
    // It is the least z at which reflections still leave the surface: below it none does, just above it some do.
    for (double alpha : {0.2, 0.5, 0.9})
        for (double NdotV : {0.1, 0.5, 0.95}) {
            const Vec3d V{std::sqrt(1 - NdotV * NdotV), 0, NdotV}, axis = normalize(Vec3d{alpha * V.x, 0, V.z});
            double least = 1;
            for (int i = 0; i < 200; ++i)
                for (int j = 0; j < 100; ++j) {
                    const double z = 1 - (1 + axis.z) * (i + 0.5) / 200, s = std::sqrt(1 - z * z),
                                 phi = k_pi * (j + 0.5) / 100;
                    const Vec3d H =
                        normalize(Vec3d{alpha * (axis.x + s * std::cos(phi)), alpha * s * std::sin(phi), axis.z + z});
                    if (2 * dot(V, H) * H.z - V.z > 0) least = std::min(least, z);
                }
            const double bound = -ggx_cap_bound(Vec3f(V), float(alpha)) * axis.z;
            CHECK(least > bound - 1e-6);
            CHECK(least < bound + 0.03);  // the grid's step
        }
}

TEST_CASE("warps: circle_point is on the circle to 1.2e-7, and exact at quarters") {
    double worst = 0;
    for (std::uint64_t i = 0; i < 400000; ++i) {
        const auto turn = std::uint32_t(i * 10737);
        const CirclePoint p = circle_point(turn);
        const double angle = 2 * k_pi * unit_double(turn);
        worst = std::max({worst, std::abs(p.x - std::cos(angle)), std::abs(p.y - std::sin(angle))});
    }
    CHECK(worst < 1.2e-7);
    const CirclePoint east = circle_point(0), north = circle_point(0x40000000u), west = circle_point(0x80000000u),
                      south = circle_point(0xc0000000u);
    CHECK((east.x == 1 && east.y == 0));
    CHECK((north.x == 0 && north.y == 1));
    CHECK((west.x == -1 && west.y == 0));
    CHECK((south.x == 0 && south.y == -1));
    for (std::uint32_t u : {0u, 0x80000000u, 0xffffffffu})
        for (const Vec3f& d : {cosine_hemisphere({u, u}), uniform_hemisphere({u, u})}) {
            CHECK(d.z > 0);
            CHECK(length(d) == doctest::Approx(1).epsilon(1e-6));
        }
}

TEST_CASE("frame: orthonormal and right-handed about any direction") {
    std::vector<Vec3f> directions{{0, 0, 1},    {0, 0, -1},     {1, 0, 0},      {0, -1, 0},
                                  {1, 0, -0.f}, {1e-4f, 0, -1}, {0, 1e-20f, -1}};
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const Vec3f d = uniform_hemisphere(random_point(4, i));
        directions.push_back(d);
        directions.push_back(-d);
    }
    double worst = 0;
    for (const Vec3f& n : directions) {
        const Frame<float> f(n);
        for (float error : {dot(f.tangent, f.bitangent), dot(f.tangent, n), dot(f.bitangent, n), length(f.tangent) - 1,
                            length(f.bitangent) - 1, length(cross(f.tangent, f.bitangent) - n)})
            worst = std::max(worst, double(std::abs(error)));
        const Vec3f v{0.36f, 0.48f, 0.8f};
        worst = std::max(worst, double(length(f.to_local(f.to_world(v)) - v)));
    }
    CHECK(worst < 1e-6);
}
