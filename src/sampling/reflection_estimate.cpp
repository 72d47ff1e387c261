#include "domelight/sampling/reflection_estimate.h"

#include "domelight/sampling/product_sampling.h"
#include "domelight/sampling/warps.h"

#include <algorithm>
#include <cassert>

// L_o = ∫ f(V, L) L_i(L) NdotL dL over the hemisphere. A strategy with density p estimates it by the mean of f L_i
// NdotL / p.

namespace domelight {
namespace {

/// The surface's local frame: normal +Z.
class Local {
  public:
    explicit Local(const Surface& surface)
        : surface_(surface), frame_(surface.normal), V(Vec3f(frame_.to_local(surface.view))) {}
    Vec3f to_world(const Vec3f& L) const { return Vec3f(frame_.to_world(Vec3d(L))); }
    Vec3f to_local(const Vec3f& d) const { return Vec3f(frame_.to_local(Vec3d(d))); }
    /// f(V, L) L_i NdotL.
    Vec3d integrand(const Vec3f& L, const Vec3f& radiance) const {
        if (L.z <= 0) return {};
        const Vec3f f = surface_.evaluate(V, L);
        return Vec3d{double(f.x) * radiance.x, double(f.y) * radiance.y, double(f.z) * radiance.z} * double(L.z);
    }

  private:
    const Surface& surface_;
    Frame<double> frame_;

  public:
    const Vec3f V;
};

/// Mean and variance of the contributions.
class Mean {
  public:
    void add(const Vec3d& x) {
        ++count_;
        const Vec3d before = x - mean_;
        mean_ += before / double(count_);
        const Vec3d after = x - mean_;
        squares_ += Vec3d{before.x * after.x, before.y * after.y, before.z * after.z};
    }
    Estimate estimate(int samples) const {
        const auto error = [&](double s) { return count_ > 1 ? std::sqrt(s / (double(count_) * (count_ - 1))) : 0; };
        return {mean_, {error(squares_.x), error(squares_.y), error(squares_.z)}, samples};
    }

  private:
    std::int64_t count_ = 0;
    Vec3d mean_, squares_;
};

/// The Riemann sum: sum f L cos(theta) sin(theta) dtheta dphi at the midpoints of K x J steps.
Estimate riemann(const Local& local, const EnvironmentSampler& sampler, int samples) {
    const int k = std::max(1, int(std::sqrt(samples / 4.0))), j = std::max(1, samples / k);
    const double dtheta = k_pi / 2 / k, dphi = 2 * k_pi / j;
    Vec3d sum;
    for (int a = 0; a < k; ++a)
        for (int b = 0; b < j; ++b) {
            const double theta = (a + 0.5) * dtheta, phi = (b + 0.5) * dphi, s = std::sin(theta);
            const Vec3f L(Vec3d{s * std::cos(phi), s * std::sin(phi), std::cos(theta)});
            sum += local.integrand(L, sampler.radiance(local.to_world(L))) * (s * dtheta * dphi);
        }
    return {sum, {}, k * j};
}

/// One strategy alone: the mean of integrand / density. draw(point) gives a local direction with its density; if the
/// density is 0 the sample counts and adds nothing.
template <typename Draw>
Estimate one_strategy(const Local& local, const EstimateOptions& o, const Draw& draw) {
    Mean mean;
    for (int i = 0; i < o.samples; ++i) {
        const auto [L, radiance, pdf] = draw(unit_point(o.sequence, o.seed, i, o.samples));
        mean.add(pdf > 0 ? local.integrand(L, radiance) / double(pdf) : Vec3d{});
    }
    return mean.estimate(o.samples);
}

/// A local direction, the radiance from there and the density of its draw.
struct Drawn {
    Vec3f L, radiance;
    float pdf;
};

/// A draw from the BRDF and one from the environment, each weighted by a multiple importance sampling heuristic (Veach
/// 1997, eq. 9.8 and 9.13): sum of w f L cos / p.
Estimate both(const Surface& surface, const Local& local, const EnvironmentSampler& sampler, bool power,
              const EstimateOptions& o) {
    const auto weight = [power](double mine, double other) {
        return power ? mine * mine / (mine * mine + other * other) : mine / (mine + other);
    };
    const int pairs = std::max(1, o.samples / 2);
    Mean mean;
    for (int i = 0; i < pairs; ++i) {
        Vec3d sum;
        const BrdfSample b = surface.sample(local.V, unit_point(o.sequence, o.seed, i, pairs, 0));
        if (b.pdf_solid_angle > 0) {
            const LightSample light = sampler.look_up(local.to_world(b.L));
            sum += local.integrand(b.L, light.radiance) *
                            (weight(b.pdf_solid_angle, light.pdf_solid_angle) / b.pdf_solid_angle);
        }
        const LightSample e = sampler.sample(unit_point(o.sequence, o.seed, i, pairs, 1));
        if (const Vec3f L = local.to_local(e.direction); L.z > 0) {
            const float pdf_brdf = surface.pdf_solid_angle(local.V, L);
            sum += local.integrand(L, e.radiance) * (weight(e.pdf_solid_angle, pdf_brdf) / e.pdf_solid_angle);
        }
        mean.add(sum);
    }
    return mean.estimate(2 * pairs);
}

/// Resampling: the target is the luminance of the integrand, so only the colour and the estimate of the density vary.
Estimate product(const Local& local, const EnvironmentSampler& sampler, const EstimateOptions& o) {
    const int candidates = std::clamp(o.candidates, 1, 64), groups = std::max(1, o.samples / candidates);
    std::vector<UnitPoint> points(candidates);
    const auto target = [&](const LightSample& s) {
        const Vec3d value = local.integrand(local.to_local(s.direction), s.radiance);
        return float(value.x + value.y + value.z);
    };
    Mean mean;
    for (int i = 0; i < groups; ++i) {
        for (int k = 0; k < candidates; ++k)
            points[k] = unit_point(o.sequence, o.seed, i * candidates + k, groups * candidates, 0);
        const LightSample s = sample_product(sampler, target, points, unit_point(o.sequence, o.seed, i, groups, 1));
        mean.add(s.pdf_solid_angle > 0
                     ? local.integrand(local.to_local(s.direction), s.radiance) / double(s.pdf_solid_angle)
                     : Vec3d{});
    }
    return mean.estimate(groups * candidates);
}

}  // namespace

Estimate estimate_reflection(const Surface& surface, const EnvironmentSampler& sampler, Strategy strategy,
                             const EstimateOptions& options) {
    assert(options.samples >= 1);
    const Local local(surface);
    const auto look = [&](const Vec3f& L, float pdf) { return Drawn{L, sampler.radiance(local.to_world(L)), pdf}; };
    switch (strategy) {
        case Strategy::riemann:
            return riemann(local, sampler, options.samples);
        case Strategy::uniform:
            return one_strategy(local, options,
                                [&](UnitPoint u) { return look(uniform_hemisphere(u), float(0.5 / k_pi)); });
        case Strategy::cosine:
            return one_strategy(local, options, [&](UnitPoint u) {
                const Vec3f L = cosine_hemisphere(u);
                return look(L, L.z * float(1 / k_pi));
            });
        case Strategy::brdf:
            return one_strategy(local, options, [&](UnitPoint u) {
                const BrdfSample b = surface.sample(local.V, u);
                return b.pdf_solid_angle > 0 ? look(b.L, b.pdf_solid_angle) : Drawn{};
            });
        case Strategy::environment:
            return one_strategy(local, options, [&](UnitPoint u) {
                const LightSample s = sampler.sample(u);
                return Drawn{local.to_local(s.direction), s.radiance, s.pdf_solid_angle};
            });
        case Strategy::mis_balance:
            return both(surface, local, sampler, false, options);
        case Strategy::mis_power:
            return both(surface, local, sampler, true, options);
        case Strategy::product:
            break;
    }
    return product(local, sampler, options);
}

}  // namespace domelight
