#pragma once
// The reflection integral under an environment, L_o = ∫ f(V, L) L_i(L) NdotL dL, estimated by each of the usual
// strategies for choosing directions.

#include "domelight/base/names.h"
#include "domelight/sampling/brdf.h"
#include "domelight/sampling/environment_sampler.h"
#include "domelight/sampling/sequences.h"

#include <functional>

namespace domelight {

/// A surface to be lit: its BRDF in the local frame of brdf.h (normal +Z), given by three functions.
struct Surface {
    Vec3d normal{0, 1, 0};  ///< in the world, unit length
    Vec3d view{0, 1, 0};    ///< towards the viewer, unit length, not below the surface
    std::function<Vec3f(const Vec3f& V, const Vec3f& L)> evaluate;
    std::function<BrdfSample(const Vec3f& V, UnitPoint u)> sample;
    std::function<float(const Vec3f& V, const Vec3f& L)> pdf_solid_angle;
};
/// A surface with any BRDF of brdf.h.
template <typename Brdf>
Surface make_surface(const Vec3d& normal, const Vec3d& view, const Brdf& brdf) {
    return {normal, view, [brdf](const Vec3f& V, const Vec3f& L) { return brdf.evaluate(V, L); },
            [brdf](const Vec3f& V, UnitPoint u) { return brdf.sample(V, u); },
            [brdf](const Vec3f& V, const Vec3f& L) { return brdf.pdf_solid_angle(V, L); }};
}

/// How light directions are chosen.
enum class Strategy {
    riemann,      ///< the midpoints of steps in colatitude and azimuth over the hemisphere, no randomness
    uniform,      ///< uniformly over the hemisphere, p = 1 / 2 pi
    cosine,       ///< p = NdotL / pi
    brdf,         ///< the BRDF's own sampling
    environment,  ///< in proportion to radiance
    mis_balance,  ///< half BRDF, half environment, balance heuristic (Veach 1997, 9.2.2)
    mis_power,    ///< the same with the power heuristic, exponent 2
    product,      ///< a few candidates from the environment, one of them kept in proportion to f L NdotL / p (resampled
                  ///< importance sampling, Talbot 2005)
};
template <>
struct EnumNames<Strategy> {
    static constexpr const char* kind = "a strategy";
    static constexpr NamedValue<Strategy> table[] = {
        {Strategy::riemann, "riemann"},         {Strategy::uniform, "uniform"},
        {Strategy::cosine, "cosine"},           {Strategy::brdf, "brdf"},
        {Strategy::environment, "environment"}, {Strategy::mis_balance, "mis-balance"},
        {Strategy::mis_power, "mis-power"},     {Strategy::product, "product"},
    };
};

struct EstimateOptions {
    /// Directions evaluated in all; the MIS forms use half for each strategy, product counts its candidates.
    int samples = 1024;
    Sequence sequence = Sequence::random;
    std::uint64_t seed = 1;
    int candidates = 8;  ///< product: candidates for each sample kept, clamped to 1 .. 64
};

struct Estimate {
    Vec3d radiance;        ///< the estimate of L_o
    Vec3d standard_error;  ///< of the estimate, from the samples' variance: right for Sequence::random, too large for
                           ///< the other sequences, 0 for riemann
    int samples = 0;       ///< directions evaluated
};

/// L_o by one strategy. The radiance comes from `sampler` for all of them; the MIS forms accept one with compensation.
Estimate estimate_reflection(const Surface& surface, const EnvironmentSampler& sampler, Strategy strategy,
                             const EstimateOptions& options = {});

}  // namespace domelight
