#include "simd/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/area_apply.cpp"
#include "simd/area_apply.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

/// The plain version: one texel at a time.
struct Sum {
    float rgb[3];
};
constexpr int k_texels = 1;

HWY_INLINE Sum zero() {
    return {};
}
template <bool reverse>
HWY_INLINE float spread(const float* w) {
    return *w;
}
HWY_INLINE Sum add(Sum a, Sum b) {
    return {{a.rgb[0] + b.rgb[0], a.rgb[1] + b.rgb[1], a.rgb[2] + b.rgb[2]}};
}
HWY_INLINE Sum multiply_add(float weight, const float* texel, Sum sum) {
    for (int c = 0; c < 3; ++c) sum.rgb[c] += weight * texel[c];
    return sum;
}
HWY_INLINE void store(Sum total, float* out) {
    std::memcpy(out, total.rgb, sizeof total.rgb);
}

#else

/// A vector holds one or two texels of four floats.
using D = hn::CappedTag<float, 8>;
using D4 = hn::CappedTag<float, 4>;
using Sum = hn::Vec<D>;
constexpr int k_texels = int(hn::MaxLanes(D()) / 4);

HWY_INLINE Sum zero() {
    return hn::Zero(D());
}

/// Weights of the texels of one vector, each for its four floats; `w` those of two neighbouring columns, `reverse` the
/// right one first.
template <bool reverse>
HWY_INLINE Sum spread(const float* w) {
    const D d;
    if constexpr (k_texels == 2)
        return hn::ConcatLowerLower(d, hn::Set(d, w[reverse ? 0 : 1]), hn::Set(d, w[reverse ? 1 : 0]));
    else
        return hn::Set(d, w[0]);
}
HWY_INLINE Sum add(Sum a, Sum b) {
    return hn::Add(a, b);
}
HWY_INLINE Sum multiply_add(Sum weight, const float* texels, Sum sum) {
    return hn::MulAdd(weight, hn::LoadU(D(), texels), sum);
}

template <class V>
HWY_INLINE void store(V total, float* out) {
    HWY_ALIGN float rgb[4];
    if constexpr (k_texels == 2)
        hn::Store(hn::Add(hn::LowerHalf(D4(), total), hn::UpperHalf(D4(), total)), D4(), rgb);
    else
        hn::Store(total, D(), rgb);
    std::memcpy(out, rgb, 3 * sizeof(float));
}

#endif

/// The instances' sums over one stencil; all instances run in the same direction.
template <int count, bool reverse>
HWY_INLINE void sum_stencil(const Stencil& s, const float* weights, const StencilInstance* instances,
                            const RowRing& ring, bool flipped, Sum (&total)[count]) {
    const int mask = ring.capacity - 1;
    for (int i = 0; i < count; ++i) total[i] = zero();
    for (int c0 = 0; c0 < s.columns; c0 += k_ring_padding) {
        const int columns = s.columns - c0 < k_ring_padding ? s.columns - c0 : k_ring_padding;
        const float* at[count];
        for (int i = 0; i < count; ++i) {
            // The leftmost texel of these columns, then in memory always rightwards.
            int column = instances[i].column_origin + (reverse ? -(s.column + c0 + columns - 1) : s.column + c0);
            if (column < 0) column += ring.width;
            if (column < 0) column += ring.width;
            if (column >= ring.width) column -= ring.width;
            if (column >= ring.width) column -= ring.width;
            at[i] = ring.data + 4 * std::ptrdiff_t(column);
        }
        Sum sum[count];
        for (int i = 0; i < count; ++i) sum[i] = zero();
        const float* w = weights + s.first + c0;
        for (int r = 0; r < s.rows; ++r, w += s.columns) {
            const int row = flipped ? ring.height - 1 - (s.row + r) : s.row + r;
            const std::ptrdiff_t offset = (row & mask) * ring.stride;
            for (int c = 0; c < columns; c += k_texels) {
                const auto weight = spread<reverse>(w + c);
                const std::ptrdiff_t place = offset + 4 * (reverse ? columns - k_texels - c : c);
                for (int i = 0; i < count; ++i) sum[i] = multiply_add(weight, at[i] + place, sum[i]);
            }
        }
        for (int i = 0; i < count; ++i) total[i] = add(total[i], sum[i]);
    }
}

template <int count, bool reverse>
void apply(const StencilBlock& block, const StencilInstance* instances, const RowRing& ring, bool flipped, float* out) {
    const Stencil* s = block.stencils.data();
    for (int j = 0; j < block.rows; ++j)
        for (int i = 0; i < block.columns; ++i, ++s) {
            Sum total[count];
            sum_stencil<count, reverse>(*s, block.weights, instances, ring, flipped, total);
            for (int k = 0; k < count; ++k)
                store(total[k], out + 3 * (instances[k].out + i * instances[k].out_i + j * instances[k].out_j));
        }
}

void apply_stencils(const StencilBlock& block, std::span<const StencilInstance> instances, const RowRing& ring,
                    bool flipped, float* out) {
    for (std::size_t k = 0; k < instances.size();) {
        const StencilInstance* from = &instances[k];
        const bool reverse = from->direction < 0;
        std::size_t alike = 1;
        while (k + alike < instances.size() && (from[alike].direction < 0) == reverse) ++alike;
        if (alike >= 4) {
            (reverse ? apply<4, true> : apply<4, false>)(block, from, ring, flipped, out);
            k += 4;
        } else if (alike >= 2) {
            (reverse ? apply<2, true> : apply<2, false>)(block, from, ring, flipped, out);
            k += 2;
        } else {
            (reverse ? apply<1, true> : apply<1, false>)(block, from, ring, flipped, out);
            k += 1;
        }
    }
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(apply_stencils);

void apply_stencils(const StencilBlock& block, std::span<const StencilInstance> instances, const RowRing& ring,
                    bool flipped, float* out) {
    HWY_DYNAMIC_DISPATCH(apply_stencils)(block, instances, ring, flipped, out);
}

}  // namespace domelight::simd
#endif
