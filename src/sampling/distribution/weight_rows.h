#pragma once
// Reading weights row by row, with the checks that every method makes.

#include "domelight/sampling/distribution/distribution.h"

#include <functional>
#include <span>

namespace domelight {

/// Calls use(y, weights, sums) for every row, on up to `threads` threads; sums[x] is the sum of weights 0 .. x of the
/// row, in double, from left to right. Errors: as make_distribution; `use` may then have been called for some rows.
Result<void> for_each_weight_row(
    const Weights& weights, int threads,
    const std::function<void(int y, std::span<const float> row, std::span<const double> sums)>& use);

/// sums[x] of one row; returns the first weight that is NaN, infinite or negative, or -1.
int running_sums(std::span<const float> weights, std::span<double> sums);

/// The error for a bad weight.
const char* weight_fault(float weight);

/// The weights that every method uses if all weights are zero.
Weights uniform_weights(int width, int height);

/// Index of the texel that holds x in [0, 1), of n; NaN counts as 0.
inline int texel_index(double x, int n) {
    if (!(x > 0)) return 0;
    return x >= 1 ? n - 1 : std::min(int(x * n), n - 1);
}

}  // namespace domelight
