#pragma once

#include "domelight/sampling/environment_sampler.h"

#include <functional>

namespace domelight {

/// Draws from the product of an environment and something else (a cosine, a BRDF lobe) by resampling: candidates from
/// the environment, one of them kept in proportion to target / density (Talbot, Cline and Egbert 2005).
///
/// sampler      where candidates come from
/// target       >= 0, what is to be drawn in proportion to: usually the luminance of f L NdotL; called once for each
/// candidate candidates   1..64 points for them choice       the point whose x chooses among them returns      the
/// candidate kept. 1 / pdf_solid_angle is an unbiased estimate of one over its density (Talbot 2005, eq. 3.6): use it
/// as any
///              sampler's, but not in MIS weights, which need a density that depends on the direction alone. 0 where no
///              candidate had a target.
inline LightSample sample_product(const EnvironmentSampler& sampler,
                                  const std::function<float(const LightSample&)>& target,
                                  std::span<const UnitPoint> candidates, UnitPoint choice) {
    LightSample kept;
    double total = 0, xi = unit_double(choice.x);
    float kept_target = 0;
    // Weighted reservoir: the i-th replaces what was kept with probability w_i / (w_1 + ... + w_i), by one number
    // stretched again and again.
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
