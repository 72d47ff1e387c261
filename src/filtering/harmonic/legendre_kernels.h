#pragma once

#include <cstddef>

namespace domelight::simd {

/// One step of the recurrence in degree: P_{l+2} = (x^2 b - a) P_l - c P_{l-2}.
struct LegendreStep {
    double a, b, c;
};

/// Rings are handled in groups of this many; arrays over rings are padded to a multiple of it with zeros and 64-byte
/// aligned.
inline constexpr int k_ring_group = 16;

/// Writes P_l for `count` degrees (two apart) on `rings` rings to out[i * out_stride + ring], and leaves P_l and
/// P_{l-2} of the next degree in p and p_prev. The recurrence is in double, the output in float.
void legendre_rows(const LegendreStep* steps, int count, const double* x2, double* p, double* p_prev, int rings,
                   float* out, std::ptrdiff_t out_stride);

/// out[ring] = e^(log_scale + power log_x[ring]); rings is a multiple of k_ring_group.
void scaled_powers(const double* log_x, double power, double log_scale, int rings, double* out);

/// sums[i * 6 + c] += sum_ring p[i * p_stride + ring] data[c * data_stride + ring], i < count, c < 6. count is even.
void project_rows(const float* p, std::ptrdiff_t p_stride, int count, const float* data, std::ptrdiff_t data_stride,
                  int rings, float* sums);

/// out[c * out_stride + ring] += sum_i p[i * p_stride + ring] coefficients[i * 6 + c], i < count, c < 6.
void expand_rows(const float* p, std::ptrdiff_t p_stride, int count, const float* coefficients, int rings, float* out,
                 std::ptrdiff_t out_stride);

}  // namespace domelight::simd
