#pragma once

#include "domelight/sampling/distribution/bilinear.h"

#include <span>

namespace domelight::simd {

/// BilinearDistribution::sample for many points: the same bits as the scalar form, rounded to float.
void sample_bilinear(const BilinearRows& rows, const BilinearColumns& columns, const double* row_begins,
                     std::span<const UnitPoint> points, float* u, float* v, float* pdf_uv);

}  // namespace domelight::simd
