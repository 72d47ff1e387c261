#pragma once
// Light directions from an environment, in proportion to its radiance.
//
//     auto sampler = EnvironmentSampler::build(*environment);       // or of an image in memory
//     LightSample light = sampler->sample(unit_point(Sequence::sobol, seed, index, count));
//     sum += brdf(light.direction) * light.radiance * NdotL / light.pdf_solid_angle;
//
// docs/math/importance.md derives the densities.

#include "domelight/base/names.h"
#include "domelight/environment/environment.h"
#include "domelight/sampling/distribution/distribution.h"

namespace domelight {

/// The weight of a texel: texels are drawn with a probability proportional to it.
enum class LightWeight {
    radiant_power,  ///< luminance (Rec. 709) times the texel's solid angle (sin theta): the default
    /// The grayscale value 0.2989 R + 0.5866 G + 0.1145 B without sin theta, as in simple shaders; it draws too many
    /// samples at the poles.
    grayscale,
};
template <>
struct EnumNames<LightWeight> {
    static constexpr const char* kind = "a weight";
    static constexpr NamedValue<LightWeight> table[] = {
        {LightWeight::radiant_power, "radiant-power"},
        {LightWeight::grayscale, "grayscale"},
    };
};

struct EnvironmentSamplerOptions {
    /// With `bilinear` and `bilinear_plain` the radiance is interpolated bilinearly; with every other method it is that
    /// of the texel. Mixing a density of one kind with a lookup of the other would multiply the error beside a sun.
    DistributionMethod method = DistributionMethod::bilinear;
    LightWeight weight = LightWeight::radiant_power;
    /// MIS compensation (Karlik et al. 2019): the mean is subtracted from the density, so that the dim part of the sky
    /// is left to the other strategy. Use it only together with a strategy that covers the dim part; alone, the sampler
    /// would miss light. If nothing would be left (a constant environment), the density stays as it is.
    bool compensate = false;
    /// The part of the samples, [0, 1], that is drawn uniformly over the sphere (a defensive mixture): every direction
    /// has at least this share of the density 1 / 4 pi.
    double uniform_share = 0;
    int threads = 0;  ///< for building; 0: all
};

/// A light direction.
struct LightSample {
    float u = 0, v = 0;         ///< its position on the sampler's image, [0, 1)
    Vec3f direction;            ///< in the world, unit length, away from the surface
    Vec3f radiance;             ///< arriving from that direction
    float pdf_solid_angle = 0;  ///< density per steradian with which it was drawn, > 0
};

/// Light samples as a structure of arrays. Every span has as many elements as points are given.
struct LightSampleSpans {
    std::span<float> u, v;
    std::span<float> x, y, z;  ///< direction
    std::span<float> r, g, b;  ///< radiance
    std::span<float> pdf_solid_angle;
};

/// Draws light directions from an environment. Immutable once built; any number of threads may draw.
///
/// The sampler's image is a lat-long map. A cube is first averaged over the texels of one that is four times as wide as
/// a face (area_resample.h), and samples have the radiance of that map. Everything returned is finite. An environment
/// without light is sampled uniformly over the image.
class EnvironmentSampler {
  public:
    /// Reads an environment and keeps it in memory. Errors: those of reading it; no texels.
    static Result<EnvironmentSampler> build(const Environment& environment,
                                            const EnvironmentSamplerOptions& options = {});
    /// A lat-long image in memory, 3 channels, which must outlive the sampler. The light from world direction d is
    /// where the default convention has the direction world_to_source * d. Errors: no texels; a value that is NaN,
    /// infinite or negative (names the texel).
    static Result<EnvironmentSampler> build(ImageView<const float> latlong,
                                            const EnvironmentSamplerOptions& options = {},
                                            const Mat3& world_to_source = {});

    /// A direction for a point of the unit square.
    LightSample sample(UnitPoint point) const;
    /// Many samples at once: the same up to rounding, and several times as fast.
    void sample(std::span<const UnitPoint> points, const LightSampleSpans& out) const;
    /// Density per steradian with which `direction` (any length) is drawn; 0 if it never is.
    float pdf_solid_angle(const Vec3f& direction) const;
    /// Radiance from `direction` (any length), by the lookup that goes with the method.
    Vec3f radiance(const Vec3f& direction) const;
    /// Radiance and density together, for the other strategy's half of multiple importance sampling.
    LightSample look_up(const Vec3f& direction) const;
    /// Many lookups at once: u, v, radiance and density for the directions in out.x, y, z (any length but 0; not
    /// changed). The same up to rounding, and several times as fast. Leave the span of densities empty if they are not
    /// needed.
    void look_up(const LightSampleSpans& out) const;
    /// The point that sample() maps to a direction, if the method is invertible and there is no uniform share.
    std::optional<UnitPoint> invert(const Vec3f& direction) const;

    const EnvironmentSamplerOptions& options() const { return options_; }
    const Distribution2D& distribution() const { return *distribution_; }
    ImageView<const float> image() const { return image_; }
    const Mat3& world_to_source() const { return world_to_source_; }
    /// What the compensation subtracted from the luminance; 0 without compensation.
    double compensation() const { return compensation_; }
    /// Bytes of the tables, without the pixels.
    std::size_t memory_bytes() const { return distribution_->memory_bytes(); }

  private:
    EnvironmentSampler() = default;
    static Result<EnvironmentSampler> build(EnvironmentSampler sampler);
    LightSample at(float u, float v, float pdf_uv) const;
    LightSample uniform(UnitPoint point) const;
    Vec3f texel(float u, float v) const;
    float density(double pdf_uv, float sin_theta) const;

    EnvironmentSamplerOptions options_;
    std::shared_ptr<const ImageF> owned_;
    ImageView<const float> image_;
    Mat3 world_to_source_;
    double compensation_ = 0;
    std::unique_ptr<Distribution2D> distribution_;
};

/// The tables as textures for a shader that samples by binary search, or by a loop that adds up weights. RG float: R is
/// the cumulative share up to and including the texel (1 for the last), G the density over the unit square. See
/// docs/math/importance.md for the ten lines that read them.
struct SamplingTextures {
    ImageF rows;     ///< 1 wide, height rows: the marginal
    ImageF columns;  ///< width x height: each row's conditional
    /// The average weight of each row (luminance times sin theta, or as EnvironmentSamplerOptions::weight says); one
    /// channel, 1 x height texels; all 0 in an environment without light. It serves a shader without cumulative tables:
    /// a loop adds up these averages until the sum reaches xi times their total, then adds up the weights of the row
    /// found.
    ImageF row_averages;
    double total_average = 0;  ///< the average of the row averages
};
SamplingTextures sampling_textures(const EnvironmentSampler& sampler);

}  // namespace domelight
