#include "filtering/resample/reproject_interpolate.h"

#include <cmath>

namespace domelight::reproject_detail {

namespace {

constexpr int k_corners = k_tile + 1;
using Weights = std::array<double, NodeGrid::k_nodes>;

/// Lagrange's polynomials at a position.
Weights lagrange(double at) {
    Weights w;
    for (int k = 0; k < NodeGrid::k_nodes; ++k) {
        w[std::size_t(k)] = 1;
        for (int other = 0; other < NodeGrid::k_nodes; ++other)
            if (other != k)
                w[std::size_t(k)] *= (at - NodeGrid::node(other)) / (NodeGrid::node(k) - NodeGrid::node(other));
    }
    return w;
}

struct Tables {
    std::array<Weights, k_corners> corners;
    std::array<std::array<Weights, 2>, NodeGrid::k_tests> tests;
    Tables() {
        for (int i = 0; i < k_corners; ++i) corners[std::size_t(i)] = lagrange(i);
        for (int k = 0; k < NodeGrid::k_tests; ++k) {
            const SourcePoint p = NodeGrid::test(k);
            tests[std::size_t(k)] = {lagrange(p.x), lagrange(p.y)};
        }
    }
};
const Tables& tables() {
    static const Tables made;
    return made;
}

}  // namespace

double NodeGrid::node(int k) {
    return 0.5 * k_tile * (1 - std::cos(k_pi * k / (k_nodes - 1)));
}

SourcePoint NodeGrid::test(int k) {
    constexpr double between[] = {0.05 * k_tile, 0.21 * k_tile, 0.5 * k_tile, 0.79 * k_tile, 0.95 * k_tile};
    return {between[k], between[(2 * k + 1) % k_tests]};
}

double NodeGrid::at_test(int k) const {
    const auto& [across, down] = tables().tests[std::size_t(k)];
    double sum = 0;
    for (std::size_t j = 0; j < k_nodes; ++j)
        for (std::size_t i = 0; i < k_nodes; ++i) sum += down[j] * across[i] * value_[j * k_nodes + i];
    return sum;
}

void NodeGrid::at_corners(std::span<double> out) const {
    const auto& weights = tables().corners;
    // Each row of nodes at all columns of corners, then each column at all rows.
    std::array<std::array<double, k_corners>, k_nodes> rows;
    for (std::size_t j = 0; j < k_nodes; ++j)
        for (std::size_t i = 0; i < k_corners; ++i) {
            double sum = 0;
            for (std::size_t k = 0; k < k_nodes; ++k) sum += weights[i][k] * value_[j * k_nodes + k];
            rows[j][i] = sum;
        }
    for (std::size_t j = 0; j < k_corners; ++j) {
        double* to = out.data() + j * k_corners;
        for (std::size_t i = 0; i < k_corners; ++i) to[i] = weights[j][0] * rows[0][i];
        for (std::size_t k = 1; k < k_nodes; ++k)
            for (std::size_t i = 0; i < k_corners; ++i) to[i] += weights[j][k] * rows[k][i];
    }
}

}  // namespace domelight::reproject_detail
