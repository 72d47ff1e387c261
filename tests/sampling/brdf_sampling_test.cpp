// The samples of BRDFs against the densities that they state, and against the albedos from the quadrature of the BRDF
// table.
#include "domelight/sampling/brdf.h"
#include "domelight/sampling/sequences.h"

#include "filtering/brdf/brdf_quadrature.h"
#include "sampling/distribution/chi_square.h"
#include "sampling/hemisphere_quadrature.h"
#include "test.h"

#include <cmath>
#include <string>
#include <vector>

using namespace domelight;
using namespace domelight::test;

namespace {

constexpr int k_polar = 18, k_azimuth = 12, k_patches = k_polar * k_azimuth;
constexpr int k_samples = 60000;

/// The view at this angle from the normal, at an arbitrary azimuth; of unit length in float.
Vec3f view(double degrees) {
    const double theta = degrees * k_pi / 180;
    if (degrees == 0) return {0, 0, 1};
    return Vec3f(normalize(Vec3d{std::sin(theta) * std::cos(0.7), std::sin(theta) * std::sin(0.7), std::cos(theta)}));
}

/// Counts by patch, the last one below the horizon, and the mean of weight with its standard error.
struct Drawn {
    std::vector<double> counts = std::vector<double>(k_patches + 1);
    double mean = 0, error = 0;
};

template <typename Brdf>
Drawn draw(const Brdf& brdf, const Vec3f& V, std::uint64_t seed, int samples = k_samples) {
    Drawn out;
    double sum = 0, squares = 0;
    for (int i = 0; i < samples; ++i) {
        const BrdfSample s = brdf.sample(V, random_point(seed, std::uint32_t(i)));
        const bool above = s.pdf_solid_angle > 0;
        ++out.counts[above ? hemisphere_patch_of(Vec3d(s.L), k_polar, k_azimuth) : k_patches];
        sum += s.weight.y, squares += double(s.weight.y) * s.weight.y;
    }
    out.mean = sum / samples;
    out.error = std::sqrt(std::max(0.0, squares / samples - out.mean * out.mean) / samples);
    return out;
}

/// ∫ pdf dω over each patch; the last value is 1 minus their sum.
template <typename Brdf>
std::vector<double> expected_counts(const Brdf& brdf, const Vec3f& V) {
    std::vector<double> out(k_patches + 1);
    double sum = 0;
    for (int i = 0; i < k_patches; ++i) {
        const auto pdf = [&](const Vec3d& L) { return double(brdf.pdf_solid_angle(V, Vec3f(L))); };
        sum += out[i] = integrate(hemisphere_patch(i, k_polar, k_azimuth), pdf, 2e-6);
    }
    out[k_patches] = std::max(0.0, 1 - sum);
    return out;
}

template <typename Brdf>
double albedo_by_quadrature(const Brdf& brdf, const Vec3f& V) {
    double sum = 0;
    for (int i = 0; i < k_patches; ++i)
        sum += integrate(
            hemisphere_patch(i, k_polar, k_azimuth),
            [&](const Vec3d& L) { return double(brdf.evaluate(V, Vec3f(L)).y) * L.z; }, 2e-6);
    return sum;
}

/// Chi-square over the patches and the horizon, and the density's integral against the share that was drawn above.
template <typename Brdf>
void check_density(const std::string& name, const Brdf& brdf, double degrees) {
    constexpr int k_tests = 150;  // at least the number of all tests together
    static std::uint64_t seed = 100;
    const Vec3f V = view(degrees);
    const Drawn drawn = draw(brdf, V, ++seed);
    std::vector<double> expected = expected_counts(brdf, V);
    const double p = expected[k_patches], share = drawn.counts[k_patches] / k_samples;
    // 5e-5: what the quadrature of all patches may be off by (216 patches to 2e-6, errors of either sign)
    CHECK_MESSAGE(std::abs(share - p) < 4.5 * std::sqrt(p * (1 - p) / k_samples) + 5e-5, name, " at ", degrees, ": ",
                  share, " of the samples fall below the horizon, ", p, " of the density");
    for (double& e : expected) e *= k_samples;
    // If (almost) no samples are expected below the horizon, the error of the quadrature must not be taken as an
    // expected count.
    std::vector<double> observed = drawn.counts;
    if (expected[k_patches] < 5e-5 * k_samples) observed.pop_back(), expected.pop_back();
    const double significance = chi_square_p_value(observed, expected);
    CHECK_MESSAGE(significance > corrected_significance(k_tests), name, " at ", degrees, ": p = ", significance);
}

template <GgxNormals normals>
using Ggx = BasicGgxBrdf<normals>;

std::string label(const char* name, double parameter) {
    return std::string(name) + " " + std::to_string(parameter);
}

}  // namespace

TEST_CASE("brdf_sampling: samples follow the density, which leaves out what falls below the horizon") {
    for (double degrees : {0.0, 35.0, 65.0, 85.0, 89.5}) {
        check_density("lambert", LambertBrdf{}, degrees);
        for (float exponent : {0.f, 3.f, 60.f}) check_density(label("phong", exponent), PhongBrdf{exponent}, degrees);
        for (float alpha : {0.1f, 0.35f, 1.f}) {
            check_density(label("half vectors", alpha), Ggx<GgxNormals::half_vectors>{alpha}, degrees);
            check_density(label("heitz", alpha), Ggx<GgxNormals::heitz>{alpha}, degrees);
            check_density(label("caps", alpha), Ggx<GgxNormals::caps>{alpha}, degrees);
            check_density(label("bounded caps", alpha), Ggx<GgxNormals::bounded_caps>{alpha}, degrees);
        }
        for (float alpha : {0.1f, 0.4f, 1.f}) check_density(label("charlie", alpha), CharlieBrdf{alpha}, degrees);
    }
}

namespace {

/// Chi-square over tan θ_h / α and azimuth of the half vector, for lobes that patches of directions are too
/// coarse for. dl = 4 VdotH dh.
template <typename Brdf>
double narrow_significance(const Brdf& brdf, double alpha, const Vec3f& V, std::uint64_t seed) {
    constexpr int k_rings = 16, k_sectors = 8;
    const double widest = 6;
    std::vector<double> observed(k_rings * k_sectors + 1), expected(observed.size());
    for (int i = 0; i < k_samples; ++i) {
        const BrdfSample s = brdf.sample(V, random_point(seed, std::uint32_t(i)));
        const Vec3d H = Vec3d(V) + Vec3d(s.L);
        const double t = std::hypot(H.x, H.y) / H.z / alpha, phi = std::atan2(H.y, H.x) + k_pi;
        const bool inside = s.pdf_solid_angle > 0 && t < widest;
        const int sector = std::min(int(phi / (2 * k_pi) * k_sectors), k_sectors - 1);
        ++observed[inside ? int(t / widest * k_rings) * k_sectors + sector : k_rings * k_sectors];
    }
    double sum = 0;
    for (int i = 0; i < k_rings * k_sectors; ++i) {
        const double ring = i / k_sectors, sector = i % k_sectors;
        const Patch p{std::atan(ring / k_rings * widest * alpha), std::atan((ring + 1) / k_rings * widest * alpha),
                      2 * k_pi * sector / k_sectors - k_pi, 2 * k_pi * (sector + 1) / k_sectors - k_pi};
        sum += expected[i] = k_samples * integrate(
                                             p,
                                             [&](const Vec3d& H) {
                                                 const double VdotH = dot(Vec3d(V), H);
                                                 const Vec3d L = H * (2 * VdotH) - Vec3d(V);
                                                 return brdf.pdf_solid_angle(V, Vec3f(L)) * 4 * VdotH;
                                             },
                                             2e-6);
    }
    expected.back() = k_samples - sum;
    return chi_square_p_value(observed, expected);
}

/// ∫ pdf dω over light directions, and the mean weight of the samples, agree with `truth`.
template <typename Brdf>
void check_albedo(const std::string& name, const Brdf& brdf, const Vec3f& V, double truth, std::uint64_t seed) {
    const Drawn drawn = draw(brdf, V, seed, 20000);
    // 1e-5: float weights, and the quadrature of the table
    CHECK_MESSAGE(std::abs(drawn.mean - truth) < 4.5 * drawn.error + 1e-5, name, " at NdotV ", V.z, ": ", drawn.mean,
                  " +- ", drawn.error, ", not ", truth);
}

}  // namespace

TEST_CASE("brdf_sampling: narrow GGX lobes follow their density too") {
    // 3 views x 2 widths x 4 forms = 24 tests. At α = 0.001, directions in float still resolve 1e-4 of the width.
    std::uint64_t seed = 500;
    for (double degrees : {0.0, 40.0, 70.0})
        for (float alpha : {0.001f, 0.02f}) {
            const Vec3f V = view(degrees);
            const double least = corrected_significance(24);
            CHECK(narrow_significance(Ggx<GgxNormals::half_vectors>{alpha}, alpha, V, ++seed) > least);
            CHECK(narrow_significance(Ggx<GgxNormals::heitz>{alpha}, alpha, V, ++seed) > least);
            CHECK(narrow_significance(Ggx<GgxNormals::caps>{alpha}, alpha, V, ++seed) > least);
            CHECK(narrow_significance(Ggx<GgxNormals::bounded_caps>{alpha}, alpha, V, ++seed) > least);
        }
}

TEST_CASE("brdf_sampling: the mean of f cos / pdf is the albedo of the BRDF table's quadrature") {
    std::uint64_t seed = 900;
    const Vec3f one{1, 1, 1};
    for (double degrees : {0.0, 30.0, 60.0, 80.0, 88.0}) {
        const Vec3f V = view(degrees);
        for (float alpha : {1e-3f, 0.05f, 0.3f, 0.7f, 1.f}) {
            const BrdfTerms terms = integrate_brdf(V.z, alpha, BrdfG::correlated, {64, 128});
            for (const float f0 : {1.f, 0.04f}) {
                const double truth = terms.scale * f0 + terms.bias;
                const Vec3f colour = one * f0;
                check_albedo(label("half vectors", alpha), Ggx<GgxNormals::half_vectors>{alpha, colour}, V, truth,
                             ++seed);
                check_albedo(label("heitz", alpha), Ggx<GgxNormals::heitz>{alpha, colour}, V, truth, ++seed);
                check_albedo(label("caps", alpha), Ggx<GgxNormals::caps>{alpha, colour}, V, truth, ++seed);
                check_albedo(label("bounded", alpha), Ggx<GgxNormals::bounded_caps>{alpha, colour}, V, truth, ++seed);
            }
        }
        for (float alpha : {0.1f, 0.3f, 1.f})
            check_albedo(label("charlie", alpha), CharlieBrdf{alpha}, V, integrate_sheen(V.z, alpha, 128), ++seed);
        check_albedo("lambert", LambertBrdf{{0.3f, 0.6f, 0.9f}}, V, 0.6, ++seed);
        for (float exponent : {0.f, 5.f, 80.f})
            check_albedo(label("phong", exponent), PhongBrdf{exponent}, V, albedo_by_quadrature(PhongBrdf{exponent}, V),
                         ++seed);
    }
    // Closed forms: the modified Phong BRDF loses nothing at normal incidence, and n = 0 is twice the uniform lobe
    CHECK(albedo_by_quadrature(PhongBrdf{40}, {0, 0, 1}) == doctest::Approx(1).epsilon(1e-5));
    CHECK(albedo_by_quadrature(GgxBrdf{1}, {0, 0, 1}) ==
          doctest::Approx(integrate_brdf(1, 1, BrdfG::correlated).scale + integrate_brdf(1, 1, BrdfG::correlated).bias)
              .epsilon(1e-5));
}

TEST_CASE("brdf_sampling: bounded caps lose fewer samples than caps, and those fewer than half vectors") {
    for (double degrees : {0.0, 60.0, 85.0})
        for (float alpha : {0.3f, 1.f}) {
            const Vec3f V = view(degrees);
            const double half = draw(Ggx<GgxNormals::half_vectors>{alpha}, V, 1).counts.back(),
                         caps = draw(Ggx<GgxNormals::caps>{alpha}, V, 1).counts.back(),
                         bounded = draw(Ggx<GgxNormals::bounded_caps>{alpha}, V, 1).counts.back();
            CHECK(caps <= half + 4 * std::sqrt(half + 1));
            CHECK(bounded < caps);
            // No energy is lost at normal incidence, so the bound is exact there.
            if (degrees == 0) CHECK(bounded <= 1);
        }
}

TEST_CASE("brdf_sampling: no more light leaves than comes in") {
    for (double degrees : {0.0, 40.0, 75.0, 89.0}) {
        const Vec3f V = view(degrees);
        for (float alpha : {0.1f, 0.5f, 1.f}) CHECK(albedo_by_quadrature(GgxBrdf{alpha}, V) < 1 + 1e-4);
        for (float exponent : {0.f, 2.f, 50.f}) CHECK(albedo_by_quadrature(PhongBrdf{exponent}, V) < 1 + 1e-4);
        CHECK(albedo_by_quadrature(LambertBrdf{}, V) == doctest::Approx(1).epsilon(1e-4));
        for (float alpha : {0.25f, 1.f}) CHECK(albedo_by_quadrature(CharlieBrdf{alpha}, V) < 1);
    }
    // The sheen as defined is not bounded for narrow lobes, as its declaration says.
    CHECK(integrate_sheen(0.001, 0.1, 128) == doctest::Approx(1.335).epsilon(1e-3));
}

TEST_CASE("brdf_sampling: weights of visible normals are at most 1") {
    for (double degrees : {0.0, 45.0, 80.0, 89.9})
        for (float alpha : {1e-4f, 0.01f, 0.3f, 1.f}) {
            const Vec3f V = view(degrees);
            float heitz = 0, caps = 0, bounded = 0;
            for (std::uint32_t i = 0; i < 5000; ++i) {
                const UnitPoint u = random_point(3, i);
                heitz = std::max(heitz, Ggx<GgxNormals::heitz>{alpha}.sample(V, u).weight.x);
                caps = std::max(caps, Ggx<GgxNormals::caps>{alpha}.sample(V, u).weight.x);
                bounded = std::max(bounded, Ggx<GgxNormals::bounded_caps>{alpha}.sample(V, u).weight.x);
            }
            CHECK(heitz <= 1 + 2e-6f);  // G2 / G1 in float
            CHECK(caps <= 1 + 2e-6f);
            CHECK(bounded <= 1 + 2e-6f);
        }
}
