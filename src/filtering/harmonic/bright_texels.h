#pragma once

#include "domelight/base/vec.h"
#include "domelight/image/image.h"

#include "filtering/harmonic/row_kernels.h"
#include "filtering/lights/point_lights.h"

#include <span>
#include <vector>

namespace domelight {

/// The truncation error of a texel with less than this part of the total power is invisible.
constexpr double k_least_share = 1e-4;
/// A texel that is not this many times as bright as the mean is not a sun: the truncation errors of many such texels
/// cancel. (In small images every texel has a considerable share of the power.)
constexpr double k_least_contrast = 10;

/// The largest number of patches between texels that may hold lights. A sun consists of a few texels. If more texels are
/// so bright they form a glow: the strongest are taken, and the truncation errors of the others cancel.
constexpr int k_most_patches = 1024;

/// Finds the texels with the most power (radiance times solid angle) while the rows of a lat-long image are read.
///
/// A sun is the worst case of a truncated spectrum, because its coefficients do not decay. The truncated part of the
/// kernel (ResidualKernel), summed exactly over these texels, is what the expansion lacks.
class BrightTexels {
  public:
    BrightTexels(int width, int height, int most = 1024);

    /// The next rows, with simd::summarize of each.
    void add_rows(ImageView<const float> rows, std::span<const simd::Summary> summaries);
    /// The texels with more than k_least_share of the total power, each as the nodes of a Gauss-Legendre rule over its
    /// tent, fine enough for degrees around `band_limit`. `mean`: mean radiance.
    PointLights points(const Vec3d& mean, int band_limit) const;

  private:
    struct Texel {
        double power;  ///< of the strongest channel
        int x, y;
        float rgb[3];
    };
    /// Order of the heap: weakest first, ties by position, so that the result does not depend on how many rows are
    /// added at a time.
    static bool stronger(const Texel& a, const Texel& b) {
        return a.power != b.power ? a.power > b.power : a.y != b.y ? a.y < b.y : a.x < b.x;
    }

    int width_, height_, most_, next_row_ = 0;
    double sum_ = 0;  ///< power so far, of the channels' mean
    std::vector<Texel> heap_;
};

}  // namespace domelight
