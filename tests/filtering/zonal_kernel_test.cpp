#include "domelight/filtering/kernel/zonal_kernel.h"

#include "domelight/base/vec.h"

#include "base/gauss_legendre.h"
#include "test.h"

#include <cmath>
#include <vector>

using namespace domelight;

namespace {

/// k_l by quadrature in θ over dyadic pieces that shrink towards both ends of [0, π/2], where narrow lobes and
/// Charlie's lobe are concentrated, with Legendre polynomials in long double. It is slow and shares only density() with
/// the recurrences under test.
std::vector<double> coefficients_by_quadrature(const ZonalKernel& kernel, int band_limit, int nodes) {
    std::vector<double> pieces = {0};
    for (int k = 24; k >= 2; --k) pieces.push_back(k_pi / 2 * std::pow(2.0, -k));
    pieces.push_back(k_pi / 4);
    for (int k = 2; k <= 24; ++k) pieces.push_back(k_pi / 2 * (1 - std::pow(2.0, -k)));
    pieces.push_back(k_pi / 2);
    std::vector<double> sum(band_limit + 1, 0.0);
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
        const double a = pieces[i], b = pieces[i + 1];
        const GaussLegendre& rule = gauss_legendre(std::max(40, int(nodes * (b - a))));
        for (std::size_t j = 0; j < rule.x.size(); ++j) {
            const double theta = (a + b) / 2 + (b - a) / 2 * rule.x[j];
            const double f = 2 * k_pi * kernel.density(theta) * std::sin(theta) * (b - a) / 2 * rule.w[j];
            const long double c = std::cos((long double)theta);
            long double p0 = 1, p1 = c;
            sum[0] += f;
            for (int l = 1; l <= band_limit; ++l) {
                sum[l] += f * double(p1);
                const long double next = ((2 * l + 1) * c * p1 - l * p0) / (l + 1);
                p0 = p1;
                p1 = next;
            }
        }
    }
    return sum;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
    return worst;
}

}  // namespace

TEST_CASE("zonal_kernel: coefficients agree with brute-force quadrature, density integrates to 1") {
    // The two differ only by rounding, about 1e-14 for a sum of 1000 terms. The documented accuracy is 1e-9.
    for (Lobe lobe : {Lobe::ggx, Lobe::charlie, Lobe::phong_brdf, Lobe::phong_plain})
        for (double roughness : {0.02, 0.051, 0.1, 0.3, 0.5, 0.77, 0.95, 0.999, 0.99999, 1.0}) {
            const bool phong = lobe == Lobe::phong_brdf || lobe == Lobe::phong_plain;
            const ZonalKernel kernel{lobe, phong ? 2 / std::pow(roughness, 4) - 2 : roughness * roughness};
            const std::vector<double> k = kernel.coefficients(700);
            REQUIRE(k.size() == 701);
            CHECK(k[0] == 1);
            const std::vector<double> truth = coefficients_by_quadrature(kernel, 700, 1000);
            CHECK_MESSAGE(largest_difference(k, truth) < 1e-12, name_of(lobe), " at roughness ", roughness);
        }
}

TEST_CASE("zonal_kernel: the same at band limit 4000, and the first levels of a shorter list do not change") {
    for (const ZonalKernel& kernel :
         {ZonalKernel{Lobe::ggx, 0.0026}, ZonalKernel{Lobe::charlie, 0.02}, ZonalKernel{Lobe::phong_brdf, 2048}}) {
        const std::vector<double> k = kernel.coefficients(4000);
        CHECK(largest_difference(k, coefficients_by_quadrature(kernel, 4000, 5500)) < 1e-12);
        const std::vector<double> shorter = kernel.coefficients(7);
        for (int l = 0; l <= 7; ++l) CHECK(std::abs(shorter[l] - k[l]) < 1e-13);
    }
    CHECK(ZonalKernel::ggx(0.3).coefficients(0) == std::vector<double>{1});
}

TEST_CASE("zonal_kernel: the clamped cosine is 1, 2/3, 1/4, 0, -1/24, 0, 1/64") {
    // Ramamoorthi and Hanrahan 2001, eq. 8, over π.
    const std::vector<double> expected = {1, 2.0 / 3, 1.0 / 4, 0, -1.0 / 24, 0, 1.0 / 64};
    CHECK(largest_difference(expected, ZonalKernel::cosine().coefficients(6)) < 1e-15);
    // The Phong map of exponent 1 and the Phong BRDF of exponent 0 are the same lobe.
    CHECK(largest_difference(expected, ZonalKernel{Lobe::phong_plain, 1}.coefficients(6)) < 1e-15);
    CHECK(largest_difference(expected, ZonalKernel{Lobe::phong_brdf, 0}.coefficients(6)) < 1e-15);
    for (double theta : {0.0, 0.4, 1.5, 1.7, 3.1}) {
        const double cosine = std::max(std::cos(theta), 0.0) / k_pi;
        CHECK(ZonalKernel::cosine().density(theta) == doctest::Approx(cosine).epsilon(1e-14));
        CHECK(ZonalKernel{Lobe::phong_plain, 1}.density(theta) == doctest::Approx(cosine).epsilon(1e-14));
    }
}

TEST_CASE("zonal_kernel: ggx density is D(n.h) n.l / (4 v.h) up to its normalisation") {
    // n = v: l = reflect(v, h), n.h = v.h = cos(θ / 2); importance sampling by D n.h / (4 v.h) = D / 4, weighted by
    // n.l (Karis 2013).
    for (double alpha : {0.01, 0.2, 0.9}) {
        const auto unnormalised = [&](double theta) {
            const double NdotH = std::cos(theta / 2), d = NdotH * NdotH * (alpha * alpha - 1) + 1;
            return alpha * alpha / (k_pi * d * d) / 4 * std::max(std::cos(theta), 0.0);
        };
        const ZonalKernel kernel{Lobe::ggx, alpha};
        const double ratio = kernel.density(0.3) / unnormalised(0.3);
        for (double theta : {0.0, 0.01, 0.1, 1.0, 1.55, 2.0})
            CHECK(kernel.density(theta) ==
                  doctest::Approx(ratio * unnormalised(theta)).epsilon(1e-9));  // the cosine loses digits at 0.01
    }
}

TEST_CASE("zonal_kernel: a lobe too narrow for anything is the identity, and the width is the natural length") {
    for (double k : ZonalKernel{Lobe::ggx, 0}.coefficients(64)) CHECK(k == doctest::Approx(1).epsilon(1e-5));
    CHECK(ZonalKernel{Lobe::ggx, 0.01}.angular_width() == doctest::Approx(0.020001).epsilon(1e-6));
    CHECK(ZonalKernel::cosine().angular_width() <= k_pi);
    // At l = 16 / b only the tail from the clamp at the horizon is left.
    for (const ZonalKernel& kernel : {ZonalKernel{Lobe::ggx, 0.05}, ZonalKernel{Lobe::phong_brdf, 500}}) {
        const int band_limit = int(16 / kernel.angular_width());
        CHECK(std::abs(kernel.coefficients(band_limit).back()) < 2e-6);
    }
}
