#pragma once
// The errors of the real-time specular lobes against the reflection integral, which the tests check and
// `stretched_bench` prints.

#include "domelight/base/parallel.h"
#include "domelight/render/shading/shading.h"
#include "domelight/sampling/reflection_estimate.h"

#include "render/shading/shading_models.h"

#include <cmath>
#include <vector>

namespace domelight::test {

/// Errors of L / (1 + L), root mean square over directions and channels.
struct LobeErrors {
    double split_sum = 0, stretched = 0;
    double truth = 0;  ///< the truth's own standard error
    double ratio() const { return stretched / split_sum; }
};

/// Squares of the errors, mean.
struct SquareErrors {
    double split_sum = 0, stretched = 0, truth = 0;
    LobeErrors roots() const { return {std::sqrt(split_sum), std::sqrt(stretched), std::sqrt(truth)}; }
    SquareErrors& operator+=(const SquareErrors& o) {
        split_sum += o.split_sum, stretched += o.stretched, truth += o.truth;
        return *this;
    }
    SquareErrors operator/(double n) const { return {split_sum / n, stretched / n, truth / n}; }
};

/// Which GGX lobe is measured, and how.
struct LobeQuestion {
    double roughness = 0.5, NdotV = 0.5;
    float f0 = 1;
    int directions = 128;  ///< normals, all over the sphere, each with a viewer of its own
    int samples = 4096;    ///< of the truth, for each
};

/// Shades points that look in all directions with both models, without occlusion, and compares with the integral
/// estimated by MIS: the mean of two halves, whose difference gives the remaining noise.
inline SquareErrors lobe_errors(const LightMaps& maps, const EnvironmentSampler& sampler, const LobeQuestion& q) {
    SurfacePoint point;
    point.bsdf.kind = Bsdf::Kind::metallic_roughness;
    point.bsdf.f0 = {q.f0, q.f0, q.f0};
    point.bsdf.f90 = {1, 1, 1};
    point.bsdf.alpha = float(q.roughness * q.roughness);
    const GgxBrdf brdf{point.bsdf.alpha, point.bsdf.f0};
    const auto tone = [](double x) { return x / (1 + x); };
    std::vector<SquareErrors> each(std::size_t(q.directions));
    parallel_for(q.directions, 0, [&](int i) {
        constexpr double golden = 2.399963229728653;
        const double z = 1 - 2 * (i + 0.5) / q.directions, s = std::sqrt(1 - z * z), around = 1.7 * golden * i;
        const Vec3d N{s * std::cos(golden * i), z, s * std::sin(golden * i)};
        const double sine = std::sqrt(1 - q.NdotV * q.NdotV);
        const Vec3d V = Frame<double>(N).to_world({sine * std::cos(around), sine * std::sin(around), q.NdotV});
        SurfacePoint p = point;
        p.normal = Vec3f(N);
        ShadingOptions options;
        const Vec3f split = shade_split_sum(p, Vec3f(V), 1, maps, options).specular,
                    stretched = shade_stretched(p, Vec3f(V), 1, maps, options).specular;
        EstimateOptions estimate;
        estimate.samples = q.samples / 2;
        estimate.sequence = Sequence::sobol;
        estimate.seed = std::uint64_t(2 * i + 1);
        const Surface surface = make_surface(N, V, brdf);
        const Vec3d a = estimate_reflection(surface, sampler, Strategy::mis_balance, estimate).radiance;
        estimate.seed = std::uint64_t(2 * i + 2);
        const Vec3d b = estimate_reflection(surface, sampler, Strategy::mis_balance, estimate).radiance;
        SquareErrors& e = each[std::size_t(i)];
        const auto channel = [&](double u, double v, double one, double other) {
            const double truth = tone((u + v) / 2), noise = (tone(u) - tone(v)) / 2, d1 = tone(one) - truth,
                         d2 = tone(other) - truth;
            e += SquareErrors{d1 * d1, d2 * d2, noise * noise} / 3;
        };
        channel(a.x, b.x, split.x, stretched.x);
        channel(a.y, b.y, split.y, stretched.y);
        channel(a.z, b.z, split.z, stretched.z);
    });
    SquareErrors sum;
    for (const SquareErrors& e : each) sum += e;
    return sum / q.directions;
}

}  // namespace domelight::test
