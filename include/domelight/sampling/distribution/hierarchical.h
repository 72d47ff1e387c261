#pragma once

#include "domelight/sampling/distribution/distribution.h"

namespace domelight {

/// Warping down a pyramid of sums (Clarberg, Jarosz, Akenine-Moller, Jensen 2005, "Wavelet importance sampling", 4.2):
/// at each level the unit square is split left : right by the light in the two halves of the cell, then top : bottom
/// within the half drawn.
///
/// Neighbouring points stay neighbours in both directions, so with low-discrepancy points this method has the least
/// error of all. It is also the slowest. It is not monotone (a column's border depends on the row), but invertible. It
/// needs 5.3 bytes a texel.
class HierarchicalDistribution final : public Distribution2D {
  public:
    /// Errors: as make_distribution.
    static Result<HierarchicalDistribution> build(const Weights& weights, int threads = 1);

    DistributionSample sample(UnitPoint point) const override;
    using Distribution2D::sample;
    double pdf_uv(double u, double v) const override;
    std::optional<UnitPoint> invert(double u, double v) const override;
    int width() const override { return levels_.front().width; }
    int height() const override { return levels_.front().height; }
    std::size_t memory_bytes() const override;

  private:
    /// Sums of 2^level x 2^level texels.
    struct Level {
        int width, height;
        std::vector<float, LargeAllocator<float>> sums;
        double at(int i, int j) const { return i < width && j < height ? sums[std::size_t(j) * width + i] : 0.0; }
    };
    struct Split;
    Split split(int level, int i, int j) const;

    std::vector<Level> levels_;  // the texels first, one cell last
};

}  // namespace domelight
