#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filtering/harmonic/row_kernels.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "filtering/harmonic/batch_fft.h"
#include "filtering/harmonic/row_kernels.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;

template <int vectors>
HWY_INLINE void add_columns(const float* rows, std::ptrdiff_t stride, const float* weights, int count, float* sum) {
    const D d;
    const int lanes = int(hn::Lanes(d));
    hn::Vec<D> total[vectors];
    for (int v = 0; v < vectors; ++v) total[v] = hn::LoadU(d, sum + v * lanes);
    for (int j = 0; j < count; ++j, rows += stride) {
        const auto w = hn::Set(d, weights[j]);
        for (int v = 0; v < vectors; ++v) total[v] = hn::MulAdd(w, hn::LoadU(d, rows + v * lanes), total[v]);
    }
    for (int v = 0; v < vectors; ++v) hn::StoreU(total[v], d, sum + v * lanes);
}

void add_weighted_rows(const float* rows, std::ptrdiff_t stride, const float* weights, int count, float* sum, int n) {
    constexpr int vectors = 4;
    const int lanes = int(hn::Lanes(D()));
    int i = 0;
    for (; i + vectors * lanes <= n; i += vectors * lanes)
        add_columns<vectors>(rows + i, stride, weights, count, sum + i);
    for (; i + lanes <= n; i += lanes) add_columns<1>(rows + i, stride, weights, count, sum + i);
    // The tail uses the same instructions, so that the bits of a column do not depend on its position.
    if (i < n) {
        const hn::CappedTag<float, 1> one;
        for (; i < n; ++i) {
            auto total = hn::LoadU(one, sum + i);
            for (int j = 0; j < count; ++j)
                total = hn::MulAdd(hn::Set(one, weights[j]), hn::LoadU(one, rows + j * stride + i), total);
            hn::StoreU(total, one, sum + i);
        }
    }
}

void gather_fft_rows(const float* rows, std::ptrdiff_t stride, int texel, int width, float* out) {
    constexpr int tile = 16;  // texels: their 32-row block of the output stays in the first-level cache
    constexpr int row_count = 2 * k_fft_lanes;
    for (int x0 = 0; x0 < width; x0 += tile) {
        const int x1 = x0 + tile < width ? x0 + tile : width;
        for (int i = 0; i < row_count; ++i) {
            const float* row = rows + i * stride;
            for (int x = x0; x < x1; ++x) out[x * row_count + i] = row[x * texel];
        }
    }
}

float largest(const float* values, int n) {
    const D d;
    const int lanes = int(hn::Lanes(d));
    auto most = hn::Zero(d);
    int i = 0;
    for (; i + lanes <= n; i += lanes) most = hn::Max(most, hn::LoadU(d, values + i));
    float result = hn::GetLane(hn::MaxOfLanes(d, most));
    for (; i < n; ++i) result = values[i] > result ? values[i] : result;
    return result;
}

Summary summarize(const float* values, int n) {
    // Sixteen partial sums whatever the vectors' width.
    constexpr int partial = 16;
    const hn::CappedTag<float, partial> d;
    const int lanes = int(hn::Lanes(d));
    alignas(64) float sum[partial] = {}, most[partial] = {};
    int i = 0;
    constexpr int block = 64 * partial;  // partial sums of long rows in blocks keep the digits
    float total = 0, largest = 0;
    while (i + partial <= n) {
        const int end = std::min(i + block, n / partial * partial);
        for (int lane = 0; lane < partial; lane += lanes) {
            auto s = hn::Zero(d), m = hn::Load(d, most + lane);
            for (int k = i; k < end; k += partial) {
                const auto v = hn::LoadU(d, values + k + lane);
                s = hn::Add(s, v);
                m = hn::Max(m, v);
            }
            hn::Store(s, d, sum + lane);
            hn::Store(m, d, most + lane);
        }
        for (const float s : sum) total += s;
        i = end;
    }
    for (const float m : most) largest = std::max(largest, m);
    for (; i < n; ++i) total += values[i], largest = std::max(largest, values[i]);
    return {largest, total};
}

bool clamp_negative(float* values, int n) {
    const D d;
    const int lanes = int(hn::Lanes(d));
    auto least = hn::Zero(d);
    int i = 0;
    for (; i + lanes <= n; i += lanes) {
        const auto v = hn::LoadU(d, values + i);
        least = hn::Min(least, v);
        hn::StoreU(hn::Max(v, hn::Zero(d)), d, values + i);
    }
    bool found = hn::GetLane(hn::MinOfLanes(d, least)) < 0;
    for (; i < n; ++i)
        if (values[i] < 0) values[i] = 0, found = true;
    return found;
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(add_weighted_rows);
HWY_EXPORT(gather_fft_rows);
HWY_EXPORT(largest);
HWY_EXPORT(summarize);
HWY_EXPORT(clamp_negative);

void add_weighted_rows(const float* rows, std::ptrdiff_t stride, const float* weights, int count, float* sum, int n) {
    HWY_DYNAMIC_DISPATCH(add_weighted_rows)(rows, stride, weights, count, sum, n);
}
void gather_fft_rows(const float* rows, std::ptrdiff_t stride, int texel, int width, float* out) {
    HWY_DYNAMIC_DISPATCH(gather_fft_rows)(rows, stride, texel, width, out);
}
float largest(const float* values, int n) {
    return HWY_DYNAMIC_DISPATCH(largest)(values, n);
}
Summary summarize(const float* values, int n) {
    return HWY_DYNAMIC_DISPATCH(summarize)(values, n);
}
bool clamp_negative(float* values, int n) {
    return HWY_DYNAMIC_DISPATCH(clamp_negative)(values, n);
}

}  // namespace domelight::simd
#endif
