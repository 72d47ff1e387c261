#pragma once

#include "domelight/sampling/distribution/guided.h"

#include <span>

namespace domelight::simd {

/// GuidedDistribution::sample for many points: the same bits as the scalar form, rounded to float.
void sample_guided(const GuidedRows& marginal, const GuidedRows& conditional, std::span<const UnitPoint> points,
                   float* u, float* v, float* pdf_uv);

}  // namespace domelight::simd
