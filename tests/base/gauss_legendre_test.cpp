#include "base/gauss_legendre.h"

#include "test.h"

#include <cmath>

using namespace domelight;

TEST_CASE("gauss_legendre: known nodes, and x^k integrated exactly up to degree 2n - 1") {
    CHECK(gauss_legendre(1).x[0] == 0);
    CHECK(gauss_legendre(1).w[0] == doctest::Approx(2).epsilon(1e-15));
    CHECK(gauss_legendre(2).x[1] == doctest::Approx(1 / std::sqrt(3.0)).epsilon(1e-15));
    CHECK(gauss_legendre(3).x[2] == doctest::Approx(std::sqrt(0.6)).epsilon(1e-15));
    CHECK(gauss_legendre(3).w[1] == doctest::Approx(8.0 / 9).epsilon(1e-15));
    for (int n : {1, 2, 3, 4, 5, 8, 17, 33, 64}) {
        const GaussLegendre& rule = gauss_legendre(n);
        for (int k = 0; k < 2 * n; ++k) {
            double sum = 0;
            for (int i = 0; i < n; ++i) sum += rule.w[i] * std::pow(rule.x[i], k);
            CHECK(std::abs(sum - (k % 2 ? 0 : 2.0 / (k + 1))) < 1e-14);  // rounding of 64 terms
        }
    }
}

TEST_CASE("gauss_legendre: large rules integrate what oscillates as fast as they can follow") {
    for (int n : {700, 1999, 4800}) {
        const GaussLegendre& rule = gauss_legendre(n);
        double sum = 0, oscillation = 0, previous = -1;
        bool ascending = true;
        const double k = 1.5 * n;
        for (int i = 0; i < n; ++i) {
            sum += rule.w[i];
            oscillation += rule.w[i] * std::cos(k * (rule.x[i] + 0.3));
            ascending = ascending && rule.x[i] > previous;
            previous = rule.x[i];
        }
        CHECK(ascending);
        CHECK(std::abs(sum - 2) < 1e-12);
        // ∫ cos(k (x + 0.3)) dx over [-1, 1]. The tolerance is the rounding of the phase, 1e4 * 1e-16, over the
        // interval.
        CHECK(std::abs(oscillation - 2 * std::cos(0.3 * k) * std::sin(k) / k) < 2e-12);
    }
}
