#pragma once

#include "domelight/image/image.h"
#include "domelight/filtering/kernel/zonal_kernel.h"

#include "filtering/harmonic/bright_texels.h"
#include "filtering/harmonic/sh_analysis.h"
#include "filtering/harmonic/direct_lights.h"

#include <vector>

namespace domelight {

/// Takes the few texels that outshine everything else by far out of a lat-long image before it is expanded; their exact
/// kernel is added to each output texel instead. For narrow lobes only, where a sun is 10^7 times the darkest places
/// beside it: rounding of the float expansion, harmless anywhere else, would show there.
class BrightSplit {
  public:
    BrightSplit(int width, int height) : width_(width), height_(height) {}

    /// Sets the bright texels of the next rows to 0 and keeps them; `summaries`: simd::summarize of each row. Any
    /// choice is exact; which ones are taken (over 300 times the mean of what was left in the rows so far, k_most at
    /// most) does not depend on how rows are handed over.
    void take_from(ImageView<float> rows, std::span<const simd::Summary> summaries);
    bool empty() const { return texels_.empty(); }
    /// Spherical-harmonic coefficients of what was taken out.
    Spectrum spectrum(int band_limit, int threads) const {
        return analyse_texels(width_, height_, texels_, band_limit, threads);
    }
    /// The texels as a tree of lights for a kernel.
    struct Lights {
        std::vector<simd::LightNode> nodes;
        BrightPoints points;
    };
    Lights lights(const ZonalKernel& kernel) const;

  private:
    static constexpr int k_most = 4096;
    static constexpr double k_outshine = 300;

    class TreeBuilder;

    int width_, height_, next_row_ = 0;
    double sum_ = 0, weight_ = 0;  ///< of the channels' mean over the rows so far, without what was taken
    std::vector<LoneTexel> texels_;
};

/// A kernel in the form that the sum over lights takes, with its table if it needs one.
struct DirectKernelTable {
    explicit DirectKernelTable(const ZonalKernel& kernel);
    simd::DirectKernel view() const {
        return {scale, alpha2, {values.empty() ? nullptr : values.data(), int(values.size()) - 2}};
    }
    float scale = 0, alpha2 = 0;
    std::vector<float> values;
};

}  // namespace domelight
