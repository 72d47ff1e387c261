#pragma once

#include <vector>

namespace domelight {

/// Nodes and weights of the Gauss-Legendre rule, exact for polynomials of degree 2n - 1.
struct GaussLegendre {
    std::vector<double> x;  ///< nodes in (-1, 1), ascending, symmetric about 0
    std::vector<double> w;  ///< weights, sum 2
};

/// The rule with `n` >= 1 nodes, to a few units in the last place. Computed once for each n and kept; safe to call from
/// any thread.
const GaussLegendre& gauss_legendre(int n);

}  // namespace domelight
