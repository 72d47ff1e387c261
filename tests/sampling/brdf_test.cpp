#include "domelight/sampling/brdf.h"

#include "domelight/domelight.h"

#include "test.h"

using namespace domelight;

namespace {

Vec3f view(double degrees) {
    const double theta = degrees * k_pi / 180;
    return {float(std::sin(theta) * std::cos(0.7)), float(std::sin(theta) * std::sin(0.7)), float(std::cos(theta))};
}

template <typename Brdf>
void check_robust(const char* name, const Brdf& brdf) {
    const std::uint32_t edges[]{0, 1, 255, 256, 0x3fffffff, 0x40000000, 0x80000000, 0xc0000000, 0xfffffeff, 0xffffffff};
    int bad = 0;
    for (Vec3f V : {Vec3f{0, 0, 1}, view(45), view(89.9), view(89.9999), Vec3f{1, 0, 0}, Vec3f{-0.6f, 0.8f, 0},
                    Vec3f{0.6f, 0, -0.8f}, Vec3f{0, 0, -1}})
        for (int i = 0; i < 3000; ++i) {
            UnitPoint u = random_point(9, std::uint32_t(i));
            if (i < 100) u = {edges[i / 10], edges[i % 10]};
            const BrdfSample s = brdf.sample(V, u);
            const Vec3f f = brdf.evaluate(V, s.L);
            const bool unit = std::abs(length(s.L) - 1) < 1e-3f;
            const bool finite = std::isfinite(s.pdf_solid_angle) && std::isfinite(s.weight.x) && std::isfinite(f.x);
            const bool positive = s.pdf_solid_angle >= 0 && s.weight.x >= 0 && f.x >= 0;
            const bool same = s.pdf_solid_angle == brdf.pdf_solid_angle(V, s.L);
            const bool horizon =
                V.z >= 0 && s.L.z > k_least_cosine ? true : s.pdf_solid_angle == 0 && s.weight.x == 0 && f.x == 0;
            if (!(unit && finite && positive && same && horizon) && ++bad < 5)
                MESSAGE(name, " V ", V.x, " ", V.y, " ", V.z, " L ", s.L.x, " ", s.L.y, " ", s.L.z, " pdf ",
                        s.pdf_solid_angle, " weight ", s.weight.x, " u ", u.x, " ", u.y, " length ", length(s.L));
        }
    CHECK_MESSAGE(bad == 0, name);
}

}  // namespace

TEST_CASE("brdf: no argument in range makes anything but finite, unit and consistent values") {
    check_robust("lambert", LambertBrdf{});
    for (float exponent : {0.f, 1.f, 50.f, 1e4f, 1e7f}) check_robust("phong", PhongBrdf{exponent});
    for (float alpha : {0.f, 1e-4f, 1e-3f, 0.01f, 0.3f, 1.f}) {
        check_robust("half vectors", BasicGgxBrdf<GgxNormals::half_vectors>{alpha});
        check_robust("heitz", BasicGgxBrdf<GgxNormals::heitz>{alpha});
        check_robust("caps", BasicGgxBrdf<GgxNormals::caps>{alpha});
        check_robust("bounded caps", GgxBrdf{alpha});
        check_robust("charlie", CharlieBrdf{alpha});
    }
}

namespace {

/// The same value in double from the definition, with a unit half vector: F D G2 / (4 NdotL NdotV).
double ggx_by_definition(const Vec3f& V, const Vec3f& L, double alpha, double f0) {
    const Vec3d H = normalize(Vec3d(V) + Vec3d(L));
    const double a2 = alpha * alpha, d = H.z * H.z * (a2 - 1) + 1;
    const auto lambda = [&](double c) { return (-1 + std::sqrt(1 + a2 * (1 / (c * c) - 1))) / 2; };
    const double G2 = 1 / (1 + lambda(V.z) + lambda(L.z));
    const double F = f0 + (1 - f0) * std::pow(1 - dot(Vec3d(V), H), 5);
    return F * a2 / (k_pi * d * d) * G2 / (4 * double(V.z) * L.z);
}

template <typename Check>
void over_pairs(const Check& check) {
    for (std::uint32_t i = 0; i < 500; ++i)
        check(uniform_hemisphere(random_point(21, i)), uniform_hemisphere(random_point(21, i, 1)));
}

}  // namespace

TEST_CASE("brdf: values and densities are those of the definitions") {
    over_pairs([](const Vec3f& V, const Vec3f& L) {
        const Vec3d H = normalize(Vec3d(V) + Vec3d(L));
        for (float alpha : {0.1f, 0.5f, 1.f}) {
            const double f = ggx_by_definition(V, L, alpha, 0.04);
            CHECK(GgxBrdf{alpha, {0.04f, 0.04f, 0.04f}}.evaluate(V, L).y == doctest::Approx(f).epsilon(1e-4));
            const double a2 = double(alpha) * alpha, d = H.z * H.z * (a2 - 1) + 1, D = a2 / (k_pi * d * d);
            const double VdotH = dot(Vec3d(V), H), G1 = 2 * V.z / (V.z + std::sqrt(a2 + (1 - a2) * V.z * V.z));
            CHECK(BasicGgxBrdf<GgxNormals::half_vectors>{alpha}.pdf_solid_angle(V, L) ==
                  doctest::Approx(D * H.z / (4 * VdotH)).epsilon(1e-4));
            CHECK(BasicGgxBrdf<GgxNormals::heitz>{alpha}.pdf_solid_angle(V, L) ==
                  doctest::Approx(G1 * D / (4 * V.z)).epsilon(1e-4));
            CHECK(GgxBrdf{alpha}.pdf_solid_angle(V, L) >= BasicGgxBrdf<GgxNormals::caps>{alpha}.pdf_solid_angle(V, L));
            const double sin_h = std::hypot(H.x, H.y),
                         charlie = (2 + 1 / alpha) * std::pow(sin_h, 1 / alpha) / (2 * k_pi);
            CHECK(CharlieBrdf{alpha}.evaluate(V, L).y ==
                  doctest::Approx(charlie / (4 * (L.z + V.z - double(L.z) * V.z))).epsilon(1e-4));
            CHECK(CharlieBrdf{alpha}.pdf_solid_angle(V, L) ==
                  doctest::Approx(charlie * H.z / (4 * VdotH)).epsilon(1e-4));
        }
        const double mirror = std::max(0.f, dot(Vec3f{-V.x, -V.y, V.z}, L));
        CHECK(PhongBrdf{7}.evaluate(V, L).y == doctest::Approx(9 / (2 * k_pi) * std::pow(mirror, 7)).epsilon(1e-4));
        CHECK(PhongBrdf{7}.pdf_solid_angle(V, L) ==
              doctest::Approx(8 / (2 * k_pi) * std::pow(mirror, 7)).epsilon(1e-4));
        CHECK(LambertBrdf{{0.2f, 0.5f, 1}}.evaluate(V, L).y == doctest::Approx(0.5 / k_pi));
        CHECK(LambertBrdf{}.pdf_solid_angle(V, L) == doctest::Approx(L.z / k_pi));
    });
}

TEST_CASE("brdf: light may go either way") {
    over_pairs([](const Vec3f& V, const Vec3f& L) {
        const auto same = [&](const auto& brdf) {
            CHECK(brdf.evaluate(V, L).x == doctest::Approx(brdf.evaluate(L, V).x).epsilon(1e-5));
        };
        same(LambertBrdf{});
        same(PhongBrdf{20});
        same(GgxBrdf{0.2f, {0.04f, 0.5f, 1}});
        same(CharlieBrdf{0.3f});
    });
}

TEST_CASE("brdf: the weight is f cos / pdf") {
    for (std::uint32_t i = 0; i < 500; ++i) {
        const Vec3f V = uniform_hemisphere(random_point(22, i));
        const auto agrees = [&](const auto& brdf) {
            const BrdfSample s = brdf.sample(V, random_point(22, i, 1));
            if (s.pdf_solid_angle == 0) return;
            const Vec3f f = brdf.evaluate(V, s.L);
            CHECK(s.weight.y * s.pdf_solid_angle == doctest::Approx(f.y * s.L.z).epsilon(1e-5));
        };
        agrees(LambertBrdf{});
        agrees(PhongBrdf{20, {0.2f, 0.5f, 1}});
        agrees(GgxBrdf{0.2f, {0.04f, 0.5f, 1}});
        agrees(BasicGgxBrdf<GgxNormals::half_vectors>{0.01f});
        agrees(CharlieBrdf{0.3f});
    }
}
