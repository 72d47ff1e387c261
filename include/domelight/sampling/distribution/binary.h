#pragma once

#include "domelight/sampling/distribution/distribution.h"

namespace domelight {

/// Marginal and conditional inverse transform by binary search of cumulative sums in float, as in other renderers
/// (pbrt-v4's PiecewiseConstant2D). It is here for comparison.
///
/// Its densities are the differences of the stored sums, so they agree with the samples. But a texel of less than 2^-24
/// of its row's sum is never drawn.
class BinaryDistribution final : public Distribution2D {
  public:
    /// Errors: as make_distribution.
    static Result<BinaryDistribution> build(const Weights& weights, int threads = 1);

    DistributionSample sample(UnitPoint point) const override;
    double pdf_uv(double u, double v) const override;
    std::optional<UnitPoint> invert(double u, double v) const override;
    void sample(std::span<const UnitPoint> points, std::span<float> u, std::span<float> v,
                std::span<float> pdf_uv) const override;
    int width() const override { return width_; }
    int height() const override { return height_; }
    std::size_t memory_bytes() const override { return (rows_.size() + columns_.size()) * sizeof(float); }

  private:
    struct Place;
    Place find(UnitPoint point) const;

    int width_ = 0, height_ = 0;
    std::vector<float> rows_;                            // [height + 1]: cumulative, 0 .. 1
    std::vector<float, LargeAllocator<float>> columns_;  // [height][width + 1]
};

}  // namespace domelight
