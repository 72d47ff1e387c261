#pragma once

#include "domelight/filtering/kernel/zonal_kernel.h"

#include "filtering/lights/residual_sum.h"

#include <span>
#include <vector>

namespace domelight {

/// A kernel split into a smooth part, whose coefficients are tapered to 0 at a band limit L, and the rest:
///
///   K(θ) = Σ_{l ≤ L} w_l k_l (2l + 1)/4π P_l(cos θ) + R(θ).
///
/// The kernel is smooth but for a kink at the horizon and, for some lobes, one at the axis. A sharp end of the sum (w_l =
/// 1) would leave a residual that oscillates over the whole sphere. A gradual one (w_l falls as the integral of a Kaiser
/// window) leaves one that is confined to the neighbourhood of the kinks.
class ResidualKernel {
  public:
    /// factors: coefficients k_0..k_L of the kernel.
    ResidualKernel(const ZonalKernel& kernel, std::span<const double> factors);

    /// -(1 - w_l) k_l, l = 0..L: what is to be added to an expansion that is not tapered.
    const std::vector<double>& removed() const { return removed_; }
    simd::ResidualTable table() const {
        return {ring_.data(), int(ring_.size()) - 1, float(reach_), axis_.data(), int(axis_.size()) - 1, float(reach_)};
    }
    /// The least |cosine| beyond which |R| <= error + k_allowed K, and the least chord from the axis.
    double ring_limit(double error) const;
    double axis_limit(double error) const;

    /// R may be as large as this part of K: a light's own share of the value there is K.
    static constexpr double k_allowed = 1e-5;

  private:
    std::vector<double> removed_;
    double reach_;  ///< half the width of the ring as a cosine, and the chord from the axis
    std::vector<float> ring_, axis_;
    std::vector<double> ring_rest_, axis_rest_;  ///< [i]: the largest |R| - k_allowed K from entry i outwards
};

}  // namespace domelight
