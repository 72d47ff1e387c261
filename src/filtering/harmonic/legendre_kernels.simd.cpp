#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filtering/harmonic/legendre_kernels.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "base/float64-inl.h"
#include <hwy/contrib/math/math-inl.h>
#include "filtering/harmonic/legendre_kernels.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::CappedTag<float, k_ring_group>;
using DD = hn::Repartition<double, DF>;
using DH = hn::Rebind<float, DD>;
using VF = hn::Vec<DF>;

/// The number of recurrences that are interleaved: each is a chain of dependent operations, and interleaving several
/// hides their latency.
constexpr int k_side_by_side = 4;

/// `vectors` double vectors of rings at once; returns after `count` degrees.
template <int vectors>
HWY_INLINE void legendre_vectors(const LegendreStep* steps, int count, const double* x2, double* p, double* p_prev,
                                 float* out, std::ptrdiff_t out_stride) {
    const DD d;
    const DH half;
    const int lanes = int(hn::Lanes(d));
    hn::Vec<DD> x[vectors], now[vectors], before[vectors];
    for (int v = 0; v < vectors; ++v) {
        x[v] = hn::Load(d, x2 + v * lanes);
        now[v] = hn::Load(d, p + v * lanes);
        before[v] = hn::Load(d, p_prev + v * lanes);
    }
    for (int i = 0; i < count; ++i) {
        const auto a = hn::Set(d, steps[i].a), b = hn::Set(d, steps[i].b), c = hn::Set(d, steps[i].c);
        for (int v = 0; v < vectors; ++v) {
            hn::Store(hn::DemoteTo(half, now[v]), half, out + i * out_stride + v * lanes);
            const auto next = hn::MulSub(hn::MulSub(x[v], b, a), now[v], hn::Mul(c, before[v]));
            before[v] = now[v];
            now[v] = next;
        }
    }
    for (int v = 0; v < vectors; ++v) {
        hn::Store(now[v], d, p + v * lanes);
        hn::Store(before[v], d, p_prev + v * lanes);
    }
}

void legendre_rows(const LegendreStep* steps, int count, const double* x2, double* p, double* p_prev, int rings,
                   float* out, std::ptrdiff_t out_stride) {
    const int lanes = int(hn::Lanes(DD()));
    int r = 0;
    for (; r + k_side_by_side * lanes <= rings; r += k_side_by_side * lanes)
        legendre_vectors<k_side_by_side>(steps, count, x2 + r, p + r, p_prev + r, out + r, out_stride);
    for (; r + lanes <= rings; r += lanes)
        legendre_vectors<1>(steps, count, x2 + r, p + r, p_prev + r, out + r, out_stride);
}

void scaled_powers(const double* log_x, double power, double log_scale, int rings, double* out) {
    const DD d;
    const auto m = hn::Set(d, power), offset = hn::Set(d, log_scale), least = hn::Set(d, -700.0);
    for (int r = 0; r < rings; r += int(hn::Lanes(d)))
        hn::Store(hn::Exp(d, hn::Max(hn::MulAdd(m, hn::Load(d, log_x + r), offset), least)), d, out + r);
}

/// `degrees` rows of p against the six rows of data: degrees * 6 sums in registers.
template <int degrees>
HWY_INLINE void project(const float* p, std::ptrdiff_t p_stride, const float* data, std::ptrdiff_t data_stride,
                        int rings, float* sums) {
    const DF d;
    VF sum[degrees][6];
    for (int i = 0; i < degrees; ++i)
        for (int c = 0; c < 6; ++c) sum[i][c] = hn::Zero(d);
    for (int r = 0; r < rings; r += int(hn::Lanes(d))) {
        VF row[degrees];
        for (int i = 0; i < degrees; ++i) row[i] = hn::Load(d, p + i * p_stride + r);
        for (int c = 0; c < 6; ++c) {
            const VF value = hn::Load(d, data + c * data_stride + r);
            for (int i = 0; i < degrees; ++i) sum[i][c] = hn::MulAdd(row[i], value, sum[i][c]);
        }
    }
    for (int i = 0; i < degrees; ++i)
        for (int c = 0; c < 6; ++c) sums[i * 6 + c] += hn::GetLane(hn::SumOfLanes(d, sum[i][c]));
}

void project_rows(const float* p, std::ptrdiff_t p_stride, int count, const float* data, std::ptrdiff_t data_stride,
                  int rings, float* sums) {
    // 24 sums fit AVX-512's 32 registers, 12 fit 16.
    constexpr int degrees = HWY_TARGET == HWY_AVX3 ? 4 : 2;
    int i = 0;
    for (; i + degrees <= count; i += degrees)
        project<degrees>(p + i * p_stride, p_stride, data, data_stride, rings, sums + i * 6);
    for (; i < count; i += 2) project<2>(p + i * p_stride, p_stride, data, data_stride, rings, sums + i * 6);
}

template <int vectors>
HWY_INLINE void expand(const float* p, std::ptrdiff_t p_stride, int count, const float* coefficients, float* out,
                       std::ptrdiff_t out_stride) {
    const DF d;
    const int lanes = int(hn::Lanes(d));
    VF sum[6][vectors];
    for (int c = 0; c < 6; ++c)
        for (int v = 0; v < vectors; ++v) sum[c][v] = hn::Load(d, out + c * out_stride + v * lanes);
    for (int i = 0; i < count; ++i) {
        VF row[vectors];
        for (int v = 0; v < vectors; ++v) row[v] = hn::Load(d, p + i * p_stride + v * lanes);
        for (int c = 0; c < 6; ++c) {
            const VF a = hn::Set(d, coefficients[i * 6 + c]);
            for (int v = 0; v < vectors; ++v) sum[c][v] = hn::MulAdd(row[v], a, sum[c][v]);
        }
    }
    for (int c = 0; c < 6; ++c)
        for (int v = 0; v < vectors; ++v) hn::Store(sum[c][v], d, out + c * out_stride + v * lanes);
}

void expand_rows(const float* p, std::ptrdiff_t p_stride, int count, const float* coefficients, int rings, float* out,
                 std::ptrdiff_t out_stride) {
    constexpr int vectors = HWY_TARGET == HWY_AVX3 ? 4 : 2;
    const int lanes = int(hn::Lanes(DF()));
    int r = 0;
    for (; r + vectors * lanes <= rings; r += vectors * lanes)
        expand<vectors>(p + r, p_stride, count, coefficients, out + r, out_stride);
    for (; r < rings; r += lanes) expand<1>(p + r, p_stride, count, coefficients, out + r, out_stride);
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(legendre_rows);
HWY_EXPORT(scaled_powers);
HWY_EXPORT(project_rows);
HWY_EXPORT(expand_rows);

void legendre_rows(const LegendreStep* steps, int count, const double* x2, double* p, double* p_prev, int rings,
                   float* out, std::ptrdiff_t out_stride) {
    HWY_DYNAMIC_DISPATCH(legendre_rows)(steps, count, x2, p, p_prev, rings, out, out_stride);
}
void scaled_powers(const double* log_x, double power, double log_scale, int rings, double* out) {
    HWY_DYNAMIC_DISPATCH(scaled_powers)(log_x, power, log_scale, rings, out);
}
void project_rows(const float* p, std::ptrdiff_t p_stride, int count, const float* data, std::ptrdiff_t data_stride,
                  int rings, float* sums) {
    HWY_DYNAMIC_DISPATCH(project_rows)(p, p_stride, count, data, data_stride, rings, sums);
}
void expand_rows(const float* p, std::ptrdiff_t p_stride, int count, const float* coefficients, int rings, float* out,
                 std::ptrdiff_t out_stride) {
    HWY_DYNAMIC_DISPATCH(expand_rows)(p, p_stride, count, coefficients, rings, out, out_stride);
}

}  // namespace domelight::simd
#endif
