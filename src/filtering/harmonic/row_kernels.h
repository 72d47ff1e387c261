#pragma once

#include <cstddef>

namespace domelight::simd {

/// sum[i] += weights[0] rows[i] + weights[1] rows[i + stride] + ..., `count` rows, i < n. The sum is in the order of
/// the rows, so its bits do not depend on how many rows are added at a time.
void add_weighted_rows(const float* rows, std::ptrdiff_t stride, const float* weights, int count, float* sum, int n);

/// One channel of 32 rows into the layout of BatchFft: out[x * 32 + i] = rows[i * stride + x * texel].
void gather_fft_rows(const float* rows, std::ptrdiff_t stride, int texel, int width, float* out);

/// The largest of n values (at least 0).
float largest(const float* values, int n);

/// The largest (at least 0) and the sum of n values, the same bits on every instruction set.
struct Summary {
    float largest, sum;
};
Summary summarize(const float* values, int n);

/// Sets negative values of n to 0; returns whether there was one.
bool clamp_negative(float* values, int n);

}  // namespace domelight::simd
