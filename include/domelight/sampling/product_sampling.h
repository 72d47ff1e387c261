#pragma once

#include "domelight/sampling/environment_sampler.h"

#include <functional>

namespace domelight {

/// Samples the product of an environment and another function (a cosine, a BRDF lobe) by resampling: candidates are
/// drawn from the environment, and one of them is kept in proportion to target / density (Talbot, Cline and Egbert
/// 2005).
///
// clang-format off
/// sampler     draws the candidates
/// target      the function to sample in proportion to, >= 0: usually the luminance of f L NdotL; called once for each
///             candidate
/// candidates  the points, one for each candidate; at least one
/// choice      the point whose x chooses among the candidates
/// returns     the candidate kept. Its pdf_solid_angle is not its true density, but 1 / pdf_solid_angle is an unbiased
///             estimate of 1 / density (Talbot 2005, eq. 3.6): divide by it as usual, but do not use it in MIS weights,
///             which need a density that depends on the direction alone. pdf_solid_angle is 0 if no candidate had a
///             target above 0.
// clang-format on
inline LightSample sample_product(const EnvironmentSampler& sampler,
                                  const std::function<float(const LightSample&)>& target,
                                  std::span<const UnitPoint> candidates, UnitPoint choice) {
    LightSample kept;
    double total = 0, xi = unit_double(choice.x);
    float kept_target = 0;
    // Weighted reservoir sampling: the i-th candidate replaces the one kept so far with probability w_i / (w_1 + ... +
    // w_i). All decisions use one random number, which is rescaled to [0, 1) after each.
    for (const UnitPoint& point : candidates) {
        const LightSample candidate = sampler.sample(point);
        const float t = target(candidate);
        if (!(t > 0)) continue;
        const double weight = double(t) / candidate.pdf_solid_angle;
        total += weight;
        const double share = weight / total;
        if (xi < share) {
            kept = candidate;
            kept_target = t;
            xi /= share;
        } else {
            xi = (xi - share) / (1 - share);
        }
    }
    kept.pdf_solid_angle = total > 0 ? float(kept_target * double(candidates.size()) / total) : 0;
    return kept;
}

}  // namespace domelight
