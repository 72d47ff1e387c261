#pragma once

#include <span>

#include "domelight/distribution_guided.h"

namespace domelight::simd {

/// GuidedDistribution::sample for many points: the same bits as the scalar form, rounded to float.
void sample_guided(const GuidedRows& marginal, const GuidedRows& conditional, std::span<const UnitPoint> points, float* u, float* v, float* pdf_uv);

}  // namespace domelight::simd
