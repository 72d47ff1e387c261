#pragma once
// The sun and other small bright sources of an environment as lights of their own, and the environment without them.
//
//     auto found = extract_lights(image);
//     for (const ExtractedLight& light : found->lights) shade(light.direction, light.irradiance);  // with shadows
//     auto rest = Environment::from_latlong(std::move(found->remainder));  // to bake or to sample without the lights
//
// docs/lights.md says how a source is found and what the numbers mean.

#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/image/image.h"

#include <cstdint>
#include <vector>

namespace domelight {

/// What counts as a small bright source.
struct LightExtractionOptions {
    int max_lights = 8;         ///< the strongest are kept, 0 .. 1024
    double least_share = 0.01;  ///< of the environment's luminance that a light must hold, 0 .. 1
    /// The least contrast c of a source, 1.5 .. 1e6: in every direction the luminance must fall to peak / c or less
    /// within the largest diameter, and the mean luminance around the source must be at most the source's mean
    /// luminance / c.
    double least_contrast = 4;
    /// The largest diameter of a source that can be a light, in degrees, 0.001 .. 30. A source up to three texels
    /// across may be larger. In an image whose texels are wider than the largest diameter, no lights are found.
    double largest_diameter_deg = 6;
    /// Sources closer than this (degrees, 0 .. 30) are merged into one light: a sun behind twigs.
    double merge_deg = 1.5;
    int threads = 0;  ///< 0: all. The results do not depend on it
};

/// Errors: an option out of its range, which the error names.
Result<void> check_light_extraction_options(const LightExtractionOptions& options);

/// A directional or disc light: the light of a source in excess of its surroundings.
struct ExtractedLight {
    Vec3d direction;      ///< towards the light, in the world, unit length: the centroid of its luminance
    double u = 0, v = 0;  ///< the same on the source image, 0..1
    /// The diameter of a uniform disc with the same second moment (a disc of diameter D has the variance D^2 / 16 on
    /// each axis), corrected for the texels' width and without distant glare. If the source is not `resolved`, this is
    /// the width of one texel, an upper bound.
    double angular_diameter_deg = 0;
    bool resolved = false;  ///< whether the diameter is wider than a texel
    Vec3d irradiance;       ///< RGB on a surface that faces the light; in the image's radiance times steradian
    Vec3d mean_radiance;    ///< RGB: irradiance over the solid angle of a disc of that diameter
    Vec3d colour;           ///< irradiance over its largest channel: linear Rec. 709, 0..1
    double share = 0;       ///< of the environment's luminance over all directions, 0..1
    double contrast = 0;    ///< the peak luminance over the highest luminance along the rim; infinite in front of black
    std::int64_t texels = 0;  ///< how many texels of the source image it was taken from
};

/// The balance of power. Powers are sums of radiance times solid angle over the texels, per channel: the mean radiance
/// times 4 pi.
struct LightExtractionReport {
    Vec3d original_power, light_power, remainder_power;
    double unaccounted = 0;  ///< |original - lights - remainder| / original, the largest over the channels: rounding
    double texel_deg = 0;    ///< width of a texel, the larger of rows and columns (at the equator)
    int candidates = 0;      ///< small sources of enough contrast, before their share and their number were considered
    int left_out = 0;        ///< lights that were left in the remainder because of their share or their number
};

struct LightExtraction {
    std::vector<ExtractedLight> lights;  ///< the largest share first
    /// The image without the lights. In place of a light its surroundings are continued (harmonic interpolation), so no
    /// texel there is brighter than the rim; all other texels are unchanged. All values are >= 0, and no channel has
    /// more power than the image had.
    ImageF remainder;
    LightExtractionReport report;
};

/// Splits an environment into small bright sources and the rest.
///
/// latlong          radiance, 3 channels, rows top to bottom
/// world_to_source  the light from world direction d is where the default convention has the direction
///                  world_to_source * d, as in Environment. The lights' directions are in the world; the remainder is
///                  laid out as `latlong`.
///
/// A constant or a black image has no lights. The bits are the same on any number of threads. Errors: no texels; not 3
/// channels; a texel that is NaN, infinite or negative (named); an option out of its range.
Result<LightExtraction> extract_lights(ImageView<const float> latlong, const LightExtractionOptions& options = {},
                                       const Mat3& world_to_source = {});

}  // namespace domelight
