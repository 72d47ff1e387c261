#include "sampling/distribution/chi_square.h"

#include "test.h"

#include <random>
#include <vector>

using namespace domelight::test;

TEST_CASE("regularised_gamma_q: closed forms and tabulated quantiles") {
    for (double x : {0.01, 0.5, 1.0, 3.0, 20.0, 200.0}) {
        CHECK(regularised_gamma_q(1, x) == doctest::Approx(std::exp(-x)).epsilon(1e-12));
        CHECK(regularised_gamma_q(0.5, x) == doctest::Approx(std::erfc(std::sqrt(x))).epsilon(1e-11));
        CHECK(regularised_gamma_q(3, x) == doctest::Approx(std::exp(-x) * (1 + x + x * x / 2)).epsilon(1e-12));
    }
    CHECK(regularised_gamma_q(2, 0) == 1);
    // Upper 5 % and 0.1 % points of chi-square with 10 and 100 degrees of freedom, as printed in every table.
    CHECK(regularised_gamma_q(5, 18.307 / 2) == doctest::Approx(0.05).epsilon(1e-4));
    CHECK(regularised_gamma_q(50, 149.449 / 2) == doctest::Approx(0.001).epsilon(1e-3));
    // The median lies about 2/3 below the mean k; k = 100 000 needs many terms of the series.
    CHECK(regularised_gamma_q(5e4, (1e5 - 2.0 / 3) / 2) == doctest::Approx(0.5).epsilon(1e-3));
}

TEST_CASE("chi_square_p_value: uniform over fair draws, tiny over unfair ones") {
    std::mt19937_64 random(7);
    std::vector<double> p_values;
    for (int repeat = 0; repeat < 400; ++repeat) {
        std::vector<double> weights = {1, 2, 3, 4, 0.001, 0.002, 0.5}, observed(weights.size()), expected = weights;
        std::discrete_distribution<int> draw(weights.begin(), weights.end());
        for (int i = 0; i < 5000; ++i) observed[draw(random)] += 1;
        p_values.push_back(chi_square_p_value(observed, expected));
    }
    // Kolmogorov-Smirnov against the uniform distribution: 1.95 / √n is the 0.1 % point.
    std::sort(p_values.begin(), p_values.end());
    double largest = 0;
    for (std::size_t i = 0; i < p_values.size(); ++i)
        largest = std::max(largest, std::abs(p_values[i] - (i + 0.5) / p_values.size()));
    CHECK(largest < 1.95 / std::sqrt(400.0));

    std::vector<double> observed(100, 1000), expected(100, 1000);
    CHECK(chi_square_p_value(observed, expected) == doctest::Approx(1));
    observed[3] += 300, observed[4] -= 300;  // statistic 180 with 99 degrees of freedom
    CHECK(chi_square_p_value(observed, expected) < 2e-6);
    CHECK(chi_square_p_value(observed, expected) > 1e-7);
}

TEST_CASE("chi_square_p_value: a count where none can be is impossible; one cell says nothing") {
    CHECK(chi_square_p_value(std::vector<double>{10, 1}, std::vector<double>{11, 0}) == 0);
    CHECK(chi_square_p_value(std::vector<double>{11, 0}, std::vector<double>{11, 0}) == 1);
    CHECK(chi_square_p_value(std::vector<double>{11}, std::vector<double>{3}) == 1);
    CHECK(chi_square_p_value(std::vector<double>{1}, std::vector<double>{0}) == 0);
    CHECK(corrected_significance(100) == doctest::Approx(1e-4));
}
