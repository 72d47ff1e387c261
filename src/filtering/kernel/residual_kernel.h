#pragma once

#include "domelight/filtering/kernel/zonal_kernel.h"

#include "filtering/harmonic/zonal_sum.h"

#include <span>
#include <vector>

namespace domelight {

/// The part of kernels that truncation at a band limit L leaves out: K(theta) - sum_{l <= L} (2l + 1) / 4 pi k_l
/// P_l(cos theta), as tables over theta.
class ResidualKernels {
  public:
    /// factors[i]: coefficients k_0..k_L of kernels[i].
    ResidualKernels(std::span<const ZonalKernel> kernels, std::span<const std::vector<double>> factors, int threads);
    simd::ZonalTable table(int i) const { return {values_.data() + std::size_t(i) * (steps_ + 2), steps_}; }

  private:
    int steps_;
    std::vector<float> values_;
};

}  // namespace domelight
