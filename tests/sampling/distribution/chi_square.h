#pragma once
// Pearson's chi-square test, for every sampler's test against its density.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace domelight::test {

/// Upper regularised incomplete gamma function Q(a, x) = Gamma(a, x) / Gamma(a); a > 0, x ≥ 0; in [0, 1], to about
/// 1e-12.
///
/// Below x = a + 1 the series of P (DLMF 8.7.1), above it the continued fraction of Q (DLMF 8.9.2) by Lentz's method.
inline double regularised_gamma_q(double a, double x) {
    if (!(x > 0)) return 1;
    const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
    constexpr int k_terms = 1'000'000;  // some 8 √a are needed near x = a
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < k_terms && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
        return std::max(0.0, 1 - scale * sum);
    }
    constexpr double tiny = 1e-300;
    double b = x + 1 - a, c = 1 / tiny, d = 1 / b, fraction = d;
    for (int n = 1; n < k_terms; ++n) {
        const double an = -n * (n - a);
        b += 2;
        const double below = an * d + b, above = b + an / c;
        d = 1 / (std::abs(below) < tiny ? tiny : below);
        c = std::abs(above) < tiny ? tiny : above;
        fraction *= d * c;
        if (std::abs(d * c - 1) < 1e-15) break;
    }
    return scale * fraction;
}

/// Probability that counts as far from `expected` as `observed` (or farther) arise by chance: chi-square with (cells -
/// 1) degrees of freedom.
///
/// observed   counts in each cell
/// expected   counts expected in each cell, ≥ 0; scaled to the observed total if theirs differs (the caller tests the
/// total itself) returns    p-value in [0, 1]; 0 where a cell that expects nothing has a count; 1 where only one cell
/// is left
///
/// Pearson's statistic is chi-square distributed only if about 5 counts or more are expected in every cell, so cells
/// with fewer expected counts are pooled, in rising order of these.
inline double chi_square_p_value(std::span<const double> observed, std::span<const double> expected) {
    constexpr double least = 5;
    const double total = std::accumulate(observed.begin(), observed.end(), 0.0),
                 mass = std::accumulate(expected.begin(), expected.end(), 0.0);
    if (observed.size() != expected.size() || !std::isfinite(mass)) return 0;
    if (total == 0) return 1;
    if (!(mass > 0)) return 0;

    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });

    double statistic = 0, pooled_observed = 0, pooled_expected = 0;
    int cells = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        const double o = observed[order[k]], e = expected[order[k]] * (total / mass);
        if (!(expected[order[k]] >= 0) || (e == 0 && o > 0)) return 0;
        pooled_observed += o;
        pooled_expected += e;
        // A small remainder is added to the last cell (the largest) instead of forming a cell of its own.
        if (pooled_expected < least && k + 1 < order.size()) continue;
        if (!(pooled_expected > 0)) continue;
        statistic += (pooled_observed - pooled_expected) * (pooled_observed - pooled_expected) / pooled_expected;
        ++cells;
        pooled_observed = pooled_expected = 0;
    }
    return cells > 1 ? regularised_gamma_q(0.5 * (cells - 1), 0.5 * statistic) : 1;
}

/// Significance of one test among `tests`, so that all of them together fail by chance with probability `overall`
/// (Bonferroni).
inline double corrected_significance(int tests, double overall = 0.01) {
    return overall / std::max(1, tests);
}

}  // namespace domelight::test
