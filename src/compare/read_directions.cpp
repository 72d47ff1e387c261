#include "compare/read_directions.h"

#include "domelight/base/frame.h"
#include "domelight/base/random.h"
#include "domelight/image/colour.h"
#include "domelight/sampling/environment_sampler.h"
#include "domelight/sampling/microfacet.h"

#include <cmath>

namespace domelight {
namespace {

/// Wide enough for the surroundings of a sun, and still 200 times as dense at its centre as far from it.
constexpr float k_roughness = 0.15f;

constexpr std::array<std::uint32_t, 2> key_of(std::uint64_t seed) {
    return {std::uint32_t(seed), std::uint32_t(seed >> 32)};
}

Vec3d uniform_direction(UnitPoint u) {
    const double z = 1 - 2 * unit_double(u.x), s = std::sqrt(std::max(0.0, 1 - z * z)),
                 azimuth = 2 * k_pi * unit_double(u.y);
    return {s * std::cos(azimuth), z, s * std::sin(azimuth)};
}

/// A direction about `axis` whose density is the zonal kernel of GGX: a reflection about a half vector of density D n.h
/// has density D / 4, and is kept with probability n.l.
Vec3d lobe_direction(const Vec3d& axis, std::uint32_t index, std::uint64_t seed) {
    for (std::uint32_t trial = 0;; ++trial) {
        const auto words = philox4x32({index, trial, 1, 0}, key_of(seed));
        const Vec3f half = ggx_half_vector(k_roughness * k_roughness, {words[0], words[1]});
        const Vec3f local = reflect_about({0, 0, 1}, half);
        if (local.z > unit_float(words[2])) return normalize(Frame(axis).to_world(Vec3d(local)));
    }
}

}  // namespace

ZonalKernel ReadDirections::lobe() {
    return ZonalKernel::ggx(k_roughness);
}

Result<ReadDirections> ReadDirections::draw(const Environment& environment, int count, std::uint64_t seed,
                                            int threads) {
    EnvironmentSamplerOptions options;
    options.threads = threads;
    const auto sampler = EnvironmentSampler::build(environment, options);
    if (!sampler) return sampler.error();
    ReadDirections drawn;
    for (int i = 0; i < count; ++i) {
        const auto words = philox4x32({std::uint32_t(i), 0, 0, 0}, key_of(seed));
        const UnitPoint point{words[0], words[1]};
        const auto light = [&] { return normalize(Vec3d(sampler->sample(point).direction)); };
        const int kind = i % 4;
        drawn.directions_.push_back(kind < 2    ? uniform_direction(point)
                                    : kind == 2 ? light()
                                                : lobe_direction(light(), std::uint32_t(i), seed));
        drawn.light_pdf_.push_back(sampler->pdf_solid_angle(Vec3f(drawn.directions_.back())));
    }
    return drawn;
}

std::vector<double> ReadDirections::weights(std::span<const float> filtered, const Vec3d& mean) const {
    const std::size_t count = directions_.size();
    const double average = luminance(mean), lobes = double(count / 4) / double(count),
                 lights = double((count + 1) / 4) / double(count), uniform = 1 - lobes - lights;
    std::vector<double> weights(count, 1);
    for (std::size_t i = 0; average > 0 && i < count; ++i)
        weights[i] = 1 / (uniform + lobes * luminance(&filtered[3 * i]) / average + lights * 4 * k_pi * light_pdf_[i]);
    return weights;
}

}  // namespace domelight
