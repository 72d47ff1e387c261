#pragma once

#include "domelight/filtering/kernel/zonal_kernel.h"
#include "domelight/image/image.h"

#include "filtering/harmonic/bright_texels.h"
#include "filtering/harmonic/direct_lights.h"
#include "filtering/harmonic/sh_analysis.h"

#include <vector>

namespace domelight {

/// Removes the few texels that are much brighter than everything else from a lat-long image before it is expanded. They
/// are added to each output texel by the exact kernel instead. This is needed for narrow lobes only: a sun is then 10^7
/// times as bright as the darkest places beside it, where the rounding of a float expansion would be visible.
class BrightSplit {
  public:
    BrightSplit(int width, int height) : width_(width), height_(height) {}

    /// Sets the bright texels of the next rows to 0 and keeps them; `summaries`: simd::summarize of each row. The
    /// result is exact for any choice of texels. The choice (texels above 300 times the mean of what was left in the
    /// rows so far, at most k_most) does not depend on how many rows are added at a time.
    void take_from(ImageView<float> rows, std::span<const simd::Summary> summaries);
    bool empty() const { return texels_.empty(); }
    /// Spherical-harmonic coefficients of the texels that were removed.
    Spectrum spectrum(int band_limit, int threads) const {
        return analyse_texels(width_, height_, texels_, band_limit, threads);
    }
    /// The texels as a tree of lights for a kernel.
    struct Lights {
        std::vector<simd::LightNode> nodes;
        PointLights points;
    };
    Lights lights(const ZonalKernel& kernel) const;

  private:
    static constexpr int k_most = 4096;
    static constexpr double k_outshine = 300;

    class TreeBuilder;

    int width_, height_, next_row_ = 0;
    double sum_ = 0, weight_ = 0;  ///< of the channels' mean over the rows so far, without the removed texels
    std::vector<LoneTexel> texels_;
};

/// A kernel in the form that the sum over lights needs, with its table if it has one.
struct DirectKernelTable {
    explicit DirectKernelTable(const ZonalKernel& kernel);
    simd::DirectKernel view() const {
        return {scale, alpha2, {values.empty() ? nullptr : values.data(), int(values.size()) - 2}};
    }
    float scale = 0, alpha2 = 0;
    std::vector<float> values;
};

}  // namespace domelight
