#pragma once
// How far two pictures are apart. All take two images of the same size, RGB, and an optional mask.

#include <string>
#include <vector>

#include "domelight/image.h"

namespace domelight {

/// Pixels that count: one channel, > 0; empty: all.
using Mask = ImageView<const float>;

struct Errors {
    double rmse = 0;           ///< sqrt(mean |a - b|^2), channels together
    double relative_rmse = 0;  ///< sqrt(sum |a - b|^2 / sum |b|^2)
    double tone_mapped_rmse = 0;  ///< of L / (1 + L)
    double mean_ratio = 0;        ///< sum a / sum b
    double largest = 0;           ///< max |a - b|
    double psnr = 0;              ///< dB, of L / (1 + L), peak 1
    double ssim = 0;              ///< Wang et al. 2004, of the luminance of L / (1 + L), Gaussian window of sigma 1.5
    std::int64_t pixels = 0;
};
/// `test` against `reference`, linear radiance.
Errors compare_images(ImageView<const float> test, ImageView<const float> reference, Mask mask = {}, int threads = 0);

struct FlipOptions {
    double pixels_per_degree = 67.0206;  ///< 0.7 m from a 0.7 m wide display of 3840 pixels, the authors' default
};
/// FLIP (Andersson et al. 2020): perceived difference of each pixel, [0, 1], one channel. sRGB-encoded values in [0, 1].
ImageF flip(ImageView<const float> test_srgb, ImageView<const float> reference_srgb, const FlipOptions& options = {}, int threads = 0);

struct HdrFlip {
    ImageF error;          ///< largest over the exposures
    ImageF exposure;       ///< the exposure (stops) at which it was
    double start = 0, stop = 0;  ///< stops
    int count = 0;
};
/// HDR-FLIP (Andersson et al. 2021): the largest FLIP over exposures chosen from the reference, tone mapped by ACES as the authors do. Linear radiance.
HdrFlip hdr_flip(ImageView<const float> test, ImageView<const float> reference, const FlipOptions& options = {}, int threads = 0);
/// Mean over the mask.
double mean_of(ImageView<const float> error, Mask mask = {});

}  // namespace domelight
