#pragma once

#include "domelight/base/names.h"
#include "domelight/sampling/environment_sampler.h"

#include "image/draw.h"

#include <cstdint>
#include <span>
#include <string>

namespace domelight {

/// The title of a picture of samples.
struct SamplePictureOptions {
    std::string title, subtitle;  ///< UTF-8
    int width = 1024;             ///< pixels of the environment, which is half as high
    int threads = 0;
};

/// The environment, tone mapped (AgX, log-average luminance to 0.18) and a little subdued, with a dot where each sample
/// fell; 8-bit sRGB. The picture is the sampler's own image: u to the right, v down.
Image<std::uint8_t> sample_picture(const EnvironmentSampler& sampler, std::span<const LightSample> samples,
                                   const SamplePictureOptions& options);

/// Over what a density is stated.
enum class DensityMeasure {
    uv,          ///< over the unit square: what the tables hold
    solid_angle  ///< per steradian: pdf_uv / (2 pi^2 sin theta)
};
template <>
struct EnumNames<DensityMeasure> {
    static constexpr const char* kind = "a measure";
    static constexpr NamedValue<DensityMeasure> table[] = {
        {DensityMeasure::solid_angle, "solid-angle"},
        {DensityMeasure::uv, "uv"},
    };
};

/// The density of the sampler as a heat map with its legend, logarithmic over at most eight decades below the largest
/// value (averages over each pixel); where it is zero, hatched.
Image<std::uint8_t> density_picture(const EnvironmentSampler& sampler, DensityMeasure measure,
                                    const SamplePictureOptions& options);

/// The picture's own upper part: environment only, drawn at a place of a larger picture (used by --explain).
void draw_environment(ImageView<std::uint8_t> image, Rect where, const EnvironmentSampler& sampler, double brightness,
                      int threads);

}  // namespace domelight
