#pragma once

#include "domelight/sampling/distribution/alias.h"

#include <span>

namespace domelight::simd {

/// AliasDistribution::sample for many points: the same bits as the scalar form, rounded to float.
void sample_alias(const AliasRows& marginal, const AliasRows& conditional, std::span<const UnitPoint> points, float* u,
                  float* v, float* pdf_uv);

}  // namespace domelight::simd
