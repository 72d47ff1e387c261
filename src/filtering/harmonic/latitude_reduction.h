#pragma once

#include <vector>

namespace domelight {

/// The matrix that turns an image's rows into rows on the rings of a grid, so that sums over rings equal integrals over
/// the bilinear image.
///
/// A band-limited q (a Legendre function, of parity (-1)^m about the poles) is q(theta) = sum_k I_k(theta) q(theta_k)
/// with the interpolation taps, the image's rows are sum_j g_j Lambda_j(theta) with the tent Lambda_j (constant beyond
/// the outermost centres), hence
///   ∫ q g sin theta dtheta = sum_k q(theta_k) sum_j R_kj g_j,   R_kj = ∫ Lambda_j I_k sin theta dtheta.
/// Taps reach past the poles: rings -pad..-1 and rings..rings+pad-1 belong to the mirror ring, half a turn away.
class LatitudeReduction {
  public:
    static constexpr int k_pad = 4;

    LatitudeReduction(int image_height, int rings, double band, double decay);

    /// One row of the matrix: weights of image rows first, first + 1, ...
    struct Row {
        int first = 0;
        std::vector<float> weights;
        int end() const { return first + int(weights.size()); }
    };
    /// Ring k - k_pad, k = 0 .. rings + 2 k_pad - 1.
    const Row& row(int k) const { return rows_[k]; }
    int count() const { return int(rows_.size()); }

  private:
    std::vector<Row> rows_;
};

}  // namespace domelight
