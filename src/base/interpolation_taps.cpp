#include "base/interpolation_taps.h"

#include "domelight/base/vec.h"

#include <cassert>
#include <cmath>

namespace domelight {
namespace {

/// Solves A x = b (n x n, row-major) in place by elimination with partial pivoting; b has `columns` right-hand sides.
void solve(std::vector<double>& a, std::vector<double>& b, int n, int columns) {
    for (int i = 0; i < n; ++i) {
        int pivot = i;
        for (int r = i + 1; r < n; ++r)
            if (std::abs(a[r * n + i]) > std::abs(a[pivot * n + i])) pivot = r;
        for (int c = 0; c < n; ++c) std::swap(a[i * n + c], a[pivot * n + c]);
        for (int c = 0; c < columns; ++c) std::swap(b[i * columns + c], b[pivot * columns + c]);
        for (int r = 0; r < n; ++r) {
            if (r == i) continue;
            const double f = a[r * n + i] / a[i * n + i];
            for (int c = i; c < n; ++c) a[r * n + c] -= f * a[i * n + c];
            for (int c = 0; c < columns; ++c) b[r * columns + c] -= f * b[i * columns + c];
        }
    }
    for (int i = 0; i < n; ++i)
        for (int c = 0; c < columns; ++c) b[i * columns + c] /= a[i * n + i];
}

}  // namespace

InterpolationTaps::InterpolationTaps(int taps, double band, double decay) : taps_(taps), degree_(taps + 2) {
    assert(taps >= 2 && taps <= 16 && taps % 2 == 0 && band > 0 && band < 1);
    const int n = taps_, nodes = degree_ + 1, steps = 512;
    // Normal equations of min ∫ W |sum_k w_k e^{i w (k - t)} - 1|^2, with a Lagrange multiplier for sum w = 1.
    std::vector<double> matrix((n + 1) * (n + 1), 0.0), right((n + 1) * nodes, 0.0), t(nodes);
    for (int q = 0; q < nodes; ++q) t[q] = 0.5 - 0.5 * std::cos(k_pi * (q + 0.5) / nodes);
    std::vector<double> lag(n), rhs(n * nodes);
    for (int s = 0; s < steps; ++s) {
        const double omega = k_pi * band * (s + 0.5) / steps, x = decay * (s + 0.5) / steps;
        // (1 + x) e^{-x} approximates x K_1(x) to a few tens of per cent, which is enough for a weight.
        const double amplitude = (1 + x) * std::exp(-x), weight = (amplitude * amplitude + 1e-10) / steps;
        for (int d = 0; d < n; ++d) lag[d] += weight * std::cos(omega * d);
        for (int k = 0; k < n; ++k)
            for (int q = 0; q < nodes; ++q) rhs[k * nodes + q] += weight * std::cos(omega * (k - (n / 2 - 1) - t[q]));
    }
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) matrix[i * (n + 1) + j] = lag[std::abs(i - j)] + (i == j ? 1e-15 : 0);
        matrix[i * (n + 1) + n] = matrix[n * (n + 1) + i] = 1;
        for (int q = 0; q < nodes; ++q) right[i * nodes + q] = rhs[i * nodes + q];
    }
    for (int q = 0; q < nodes; ++q) right[n * nodes + q] = 1;
    solve(matrix, right, n + 1, nodes);

    // The polynomial through the weights at the Chebyshev nodes.
    std::vector<double> vandermonde(nodes * nodes), values(nodes * n);
    for (int q = 0; q < nodes; ++q) {
        double power = 1;
        for (int d = 0; d < nodes; ++d, power *= t[q]) vandermonde[q * nodes + d] = power;
        for (int k = 0; k < n; ++k) values[q * n + k] = right[k * nodes + q];
    }
    solve(vandermonde, values, nodes, n);
    coefficients_ = std::move(values);
    // Constants must be kept in spite of rounding: the coefficients of each power are adjusted so that the weights sum
    // to 1.
    for (int d = 0; d < nodes; ++d) {
        double sum = d == 0 ? -1 : 0;
        for (int k = 0; k < n; ++k) sum += coefficients_[d * n + k];
        for (int k = 0; k < n; ++k) coefficients_[d * n + k] -= sum / n;
    }
}

void InterpolationTaps::weights(double t, std::span<double> out) const {
    for (int k = 0; k < taps_; ++k) {
        double w = 0;
        for (int d = degree_; d >= 0; --d) w = w * t + coefficients_[d * taps_ + k];
        out[k] = w;
    }
}

}  // namespace domelight
