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

void pack_orders(const float* north, const float* south, std::ptrdiff_t stride, bool real, float* plus, float* minus) {
    const hn::CappedTag<float, k_fft_lanes> d;
    for (int i = 0; i < k_fft_lanes; i += int(hn::Lanes(d))) {
        const auto a = hn::LoadU(d, north + i), c = hn::LoadU(d, south + i);
        const auto b = real ? hn::Zero(d) : hn::LoadU(d, north + stride + i),
                   e = real ? hn::Zero(d) : hn::LoadU(d, south + stride + i);
        hn::StoreU(hn::Sub(a, e), d, plus + i);
        hn::StoreU(hn::Add(b, c), d, plus + k_fft_lanes + i);
        hn::StoreU(hn::Add(a, e), d, minus + i);
        hn::StoreU(hn::Sub(c, b), d, minus + k_fft_lanes + i);
    }
}

void unpack_orders(const float* plus, const float* minus, float c, float s, float* re, float* im) {
    const hn::CappedTag<float, k_fft_lanes> d;
    const auto vc = hn::Set(d, c), vs = hn::Set(d, s);
    const auto turn = [&](auto x, auto y, int i) HWY_ATTR {
        hn::StoreU(hn::Sub(hn::Mul(x, vc), hn::Mul(y, vs)), d, re + i);
        hn::StoreU(hn::Add(hn::Mul(x, vs), hn::Mul(y, vc)), d, im + i);
    };
    for (int i = 0; i < k_fft_lanes; i += int(hn::Lanes(d))) {
        const auto pr = hn::LoadU(d, plus + i), pi = hn::LoadU(d, plus + k_fft_lanes + i), mr = hn::LoadU(d, minus + i),
                   mi = hn::LoadU(d, minus + k_fft_lanes + i);
        turn(hn::Add(pr, mr), hn::Sub(pi, mi), i);
        turn(hn::Add(pi, mi), hn::Sub(mr, pr), k_fft_lanes + i);
    }
}

/// Four rows' pixels x0 .. x1 - 1 from lanes of the transforms.
HWY_INLINE void interleave_four(const float* r, const float* g, const float* b, int x0, int x1, float* const* rows,
                                int count) {
#if HWY_TARGET != HWY_SCALAR
    if (count >= 4) {
        const hn::FixedTag<float, 4> d;
        const auto zero = hn::Zero(d);
        for (int x = x0; x < x1; ++x) {
            const std::size_t at = std::size_t(x) * 2 * k_fft_lanes;
            const auto vr = hn::LoadU(d, r + at), vg = hn::LoadU(d, g + at), vb = hn::LoadU(d, b + at);
            const auto rg0 = hn::InterleaveLower(d, vr, vg), rg1 = hn::InterleaveUpper(d, vr, vg),
                       b0 = hn::InterleaveLower(d, vb, zero), b1 = hn::InterleaveUpper(d, vb, zero);
            hn::StoreU(hn::ConcatLowerLower(d, b0, rg0), d, rows[0] + 4 * std::ptrdiff_t(x));
            hn::StoreU(hn::ConcatUpperUpper(d, b0, rg0), d, rows[1] + 4 * std::ptrdiff_t(x));
            hn::StoreU(hn::ConcatLowerLower(d, b1, rg1), d, rows[2] + 4 * std::ptrdiff_t(x));
            hn::StoreU(hn::ConcatUpperUpper(d, b1, rg1), d, rows[3] + 4 * std::ptrdiff_t(x));
        }
        return;
    }
#endif
    for (int x = x0; x < x1; ++x)
        for (int i = 0; i < std::min(count, 4); ++i) {
            const std::size_t at = std::size_t(x) * 2 * k_fft_lanes + i;
            float* pixel = rows[i] + 4 * std::ptrdiff_t(x);
            pixel[0] = r[at], pixel[1] = g[at], pixel[2] = b[at], pixel[3] = 0;
        }
}

void interleave_rings(const float* r, const float* g, const float* b, int width, int count, float* const* north,
                      float* const* south) {
    constexpr int tile = 16;  // the transforms' part stays in the first-level cache
    for (int x0 = 0; x0 < width; x0 += tile) {
        const int x1 = std::min(x0 + tile, width);
        for (int i = 0; i < count; i += 4) {
            interleave_four(r + i, g + i, b + i, x0, x1, north + i, count - i);
            const int j = i + k_fft_lanes;
            interleave_four(r + j, g + j, b + j, x0, x1, south + i, count - i);
        }
    }
}

Texel least(const float* rgbx, int width, Texel among) {
    const hn::CappedTag<float, 16> d;
    const int lanes = int(hn::Lanes(d));
    alignas(64) float low[16];
    for (int i = 0; i < 16; i += 4) low[i] = among.r, low[i + 1] = among.g, low[i + 2] = among.b, low[i + 3] = 0;
    int i = 0;
    if (lanes >= 4) {
        auto v = hn::Load(d, low);
        for (; i + lanes <= 4 * width; i += lanes) v = hn::Min(v, hn::LoadU(d, rgbx + i));
        hn::Store(v, d, low);
    }
    for (; i < 4 * width; ++i) low[i % 4] = std::min(low[i % 4], rgbx[i]);
    for (int k = 4; k < 16; ++k) low[k % 4] = std::min(low[k % 4], low[k]);
    return {low[0], low[1], low[2]};
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
HWY_EXPORT(pack_orders);
HWY_EXPORT(unpack_orders);
HWY_EXPORT(interleave_rings);
HWY_EXPORT(least);
HWY_EXPORT(largest);
HWY_EXPORT(summarize);
HWY_EXPORT(clamp_negative);

void add_weighted_rows(const float* rows, std::ptrdiff_t stride, const float* weights, int count, float* sum, int n) {
    HWY_DYNAMIC_DISPATCH(add_weighted_rows)(rows, stride, weights, count, sum, n);
}
void gather_fft_rows(const float* rows, std::ptrdiff_t stride, int texel, int width, float* out) {
    HWY_DYNAMIC_DISPATCH(gather_fft_rows)(rows, stride, texel, width, out);
}
void pack_orders(const float* north, const float* south, std::ptrdiff_t stride, bool real, float* plus, float* minus) {
    HWY_DYNAMIC_DISPATCH(pack_orders)(north, south, stride, real, plus, minus);
}
void unpack_orders(const float* plus, const float* minus, float c, float s, float* re, float* im) {
    HWY_DYNAMIC_DISPATCH(unpack_orders)(plus, minus, c, s, re, im);
}
void interleave_rings(const float* r, const float* g, const float* b, int width, int count, float* const* north,
                      float* const* south) {
    HWY_DYNAMIC_DISPATCH(interleave_rings)(r, g, b, width, count, north, south);
}
Texel least(const float* rgbx, int width, Texel among) {
    return HWY_DYNAMIC_DISPATCH(least)(rgbx, width, among);
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
