#pragma once

#include "domelight/base/vec.h"
#include "domelight/filtering/kernel/zonal_kernel.h"

#include <algorithm>
#include <cmath>

namespace domelight {

/// A ZonalKernel prepared for many evaluations: its normalisation is computed once.
///
/// Every form is written in h = 1 - c = 2 sin^2(theta / 2) = |a - b|^2 / 2 of two unit vectors, so that narrow lobes
/// keep their digits.
class KernelDensity {
  public:
    explicit KernelDensity(const ZonalKernel& kernel);

    /// Density per steradian; `h` = 1 - c in [0, 2], `c` the cosine itself.
    double operator()(double h, double c) const {
        if (c <= 0) return 0;
        switch (lobe_) {
            case Lobe::ggx: {
                const double d = one_minus_w_ + w_ * h;  // 1 - w c
                return scale_ * c / (d * d);
            }
            case Lobe::charlie:
                return scale_ * c * std::pow(h, power_);
            default:
                return scale_ * std::exp(power_ * std::log1p(-h));  // c^p; pow(c, p) would lose log10(p) digits
        }
    }

    Lobe lobe() const { return lobe_; }
    double power() const { return power_; }
    double w() const { return w_; }
    double one_minus_w() const { return one_minus_w_; }
    double scale() const { return scale_; }

  private:
    Lobe lobe_;
    double w_ = 0, one_minus_w_ = 1;  ///< ggx: (1 - alpha^2) / (1 + alpha^2) and its complement
    double power_ = 0;                ///< charlie: of 1 - c; phong: of c
    double scale_ = 1;                ///< makes the integral over the sphere 1
};

/// Smaller widths are raised to this one: a lobe of 4 seconds of arc is a mirror at any resolution.
inline constexpr double k_least_alpha = 1e-5;

}  // namespace domelight
