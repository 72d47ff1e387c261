#pragma once
// Differences between two pictures. All functions take two RGB images of the same size and an optional mask.

#include "domelight/base/result.h"
#include "domelight/image/image.h"

#include <cstdint>
#include <string>
#include <vector>

namespace domelight {

/// Selects the pixels that count: one channel, of the images' size, > 0 where a pixel counts. Empty: all pixels count.
using Mask = ImageView<const float>;

/// Images have three channels of linear radiance unless stated otherwise, and are finite (find_bad_pixels finds values
/// that are not); test and reference have the same size. Sums are made in double in a fixed order, so the bits are the
/// same on any number of threads. If no pixel counts, every figure is 0.
struct Errors {
    double rmse = 0;              ///< sqrt(mean |a - b|^2), over pixels and channels
    double relative_rmse = 0;     ///< sqrt(sum |a - b|^2 / sum |b|^2); infinite where only the reference is black
    double tone_mapped_rmse = 0;  ///< rmse of L / (1 + L), each channel by itself; negative values count as 0
    double mean_ratio = 0;        ///< sum a / sum b over all channels; 1 if both are black
    double largest = 0;           ///< max |a - b| of any channel
    double psnr = 0;          ///< dB, of L / (1 + L), peak 1: -20 log10(tone_mapped_rmse); infinite for equal images
    double ssim = 0;          ///< mean of ssim()
    std::int64_t pixels = 0;  ///< that counted
    int largest_x = 0, largest_y = 0;  ///< where `largest` is, the first by rows
};
/// `test` against `reference`.
Errors compare_images(ImageView<const float> test, ImageView<const float> reference, Mask mask = {}, int threads = 0);

/// The errors of one object in a picture.
struct ObjectErrors {
    int index = 0;
    Errors errors;  ///< ssim: the mean over the object of the ssim() of the whole picture
};
/// The errors of each object, in the order of their indices. `objects`: the index of the object in each pixel, rounded,
/// one channel. The background, index 0, is in the result like an object. Pixels with a negative or NaN index, or one
/// from 1e9 on, are left out.
std::vector<ObjectErrors> compare_objects(ImageView<const float> test, ImageView<const float> reference,
                                          ImageView<const float> objects, Mask mask = {}, int threads = 0);

/// Structural similarity of each pixel (Wang et al. 2004, eq. 13 with K1 = 0.01, K2 = 0.03, peak 1), [-1, 1], one
/// channel: of the luminance of L / (1 + L), Gaussian window of sigma 1.5 cut at 11 x 11. Windows are normalised over
/// the pixels that count, so neither the border nor the pixels outside the mask have any influence. The result is 0
/// where the mask is 0.
ImageF ssim(ImageView<const float> test, ImageView<const float> reference, Mask mask = {}, int threads = 0);

/// The significance of a difference between images whose noise is known.
struct NoiseSummary {
    std::int64_t values = 0;               ///< channel values with a variance > 0
    std::int64_t without_noise = 0;        ///< channel values of variance 0 that differ all the same
    double mean_z = 0;                     ///< the mean of z = (a - b) / sqrt(var a + var b); 0 +- 1 / sqrt(values) for
                                           ///< unbiased images
    double chi2 = 0;                       ///< mean z^2; 1 if noise explains the whole difference
    double share_above_2 = 0;              ///< share of |z| > 2; 0.0455 for normal noise
    double total_z = 0;                    ///< z of the difference of the images' sums; beyond +-2 it indicates a bias
    double mean_ratio = 0;                 ///< sum a / sum b
    double ratio_low = 0, ratio_high = 0;  ///< its 95 % confidence interval, pixels taken as independent (delta method)
};
/// Variances are those of the pixels' values (squared standard errors), three channels; an empty view: exact.
NoiseSummary compare_noisy(ImageView<const float> test, ImageView<const float> reference,
                           ImageView<const float> test_variance, ImageView<const float> reference_variance,
                           Mask mask = {}, int threads = 0);

/// Pixels that cannot be compared: NaN or infinite in a channel.
struct BadPixels {
    std::int64_t count = 0;
    int x = 0, y = 0;  ///< the first, by rows
};
BadPixels find_bad_pixels(ImageView<const float> image, Mask mask = {});

struct FlipOptions {
    double pixels_per_degree = 67.0206;  ///< > 0; 0.7 m from a 0.7 m wide display of 3840 pixels, the authors' default
};
/// FLIP (Andersson et al. 2020): the perceived difference of each pixel, [0, 1], one channel. The images are
/// sRGB-encoded, with values in [0, 1].
ImageF flip(ImageView<const float> test_srgb, ImageView<const float> reference_srgb, const FlipOptions& options = {},
            int threads = 0);

struct HdrFlip {
    ImageF error;                ///< the largest error over the exposures
    ImageF exposure;             ///< the exposure (stops) at which it occurred
    double start = 0, stop = 0;  ///< the first and the last exposure, in stops
    int count = 0;               ///< the number of exposures
};
/// HDR-FLIP (Andersson et al. 2021): the largest FLIP over exposures chosen from the reference, tone mapped by ACES as
/// the authors do. The images are linear radiance.
HdrFlip hdr_flip(ImageView<const float> test, ImageView<const float> reference, const FlipOptions& options = {},
                 int threads = 0);
/// Mean of a one-channel image over the mask; 0 if no pixel counts.
double mean_of(ImageView<const float> error, Mask mask = {});

}  // namespace domelight
