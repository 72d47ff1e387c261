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

/// Offset of the memory of source column `column`, wrapped.
HWY_INLINE std::ptrdiff_t wrapped(int column, int width) {
    while (column < 0) column += width;
    while (column >= width) column -= width;
    return 4 * std::ptrdiff_t(column);
}

/// Adds weights * texels of `columns` source columns; `at` is where an instance's stencil column 0 lies, so that in
/// memory its texels go on from at + 4 * column, or from at - 4 * column leftwards.
template <int count, bool reverse>
HWY_INLINE void sum_columns(const Stencil& s, int column, int columns, const float* w, const float* const (&at)[count],
                            const RowRing& ring, bool flipped, Sum (&sum)[count]) {
    const int mask = ring.capacity - 1;
    for (int r = 0; r < s.rows; ++r, w += s.columns) {
        const int row = flipped ? ring.height - 1 - (s.row + r) : s.row + r;
        const std::ptrdiff_t offset = (row & mask) * ring.stride + (reverse ? -4 : 4) * std::ptrdiff_t(column) -
                                      (reverse ? 4 * (k_texels - 1) : 0);
        for (int c = 0; c < columns; c += k_texels) {
            const auto weight = spread<reverse>(w + c);
            const std::ptrdiff_t place = offset + (reverse ? -4 * c : 4 * c);
            for (int i = 0; i < count; ++i) sum[i] = multiply_add(weight, at[i] + place, sum[i]);
        }
    }
}

/// A stencil so wide that the padding behind the rows may not hold it: in parts, each wrapped by itself.
template <int count, bool reverse>
void sum_wide(const Stencil& s, const float* weights, const StencilInstance* instances, const RowRing& ring,
              bool flipped, Sum (&total)[count]) {
    for (int c0 = 0; c0 < s.columns; c0 += k_ring_padding) {
        const int columns = s.columns - c0 < k_ring_padding ? s.columns - c0 : k_ring_padding, column = s.column + c0;
        const float* at[count];
        Sum sum[count];
        for (int i = 0; i < count; ++i) {
            const int origin = instances[i].column_origin;
            at[i] = ring.data + (reverse ? wrapped(origin - (column + columns - 1), ring.width) +
                                               4 * std::ptrdiff_t(column + columns - 1)
                                         : wrapped(origin + column, ring.width) - 4 * std::ptrdiff_t(column));
            sum[i] = zero();
        }
        sum_columns<count, reverse>(s, column, columns, weights + s.first + c0, at, ring, flipped, sum);
        for (int i = 0; i < count; ++i) total[i] = add(total[i], sum[i]);
    }
}

template <int count, bool reverse>
void apply(const StencilBlock& block, const StencilInstance* instances, const RowRing& ring, bool flipped, float* out) {
    const Stencil* s = block.stencils.data();
    // Where all columns of the block fit into the row and its padding, they are wrapped once for all.
    const bool narrow = block.last_column - block.first_column < k_ring_padding;
    const float* at[count];
    for (int i = 0; i < count; ++i) {
        const int origin = instances[i].column_origin;
        at[i] = ring.data +
                (reverse ? wrapped(origin - block.last_column, ring.width) + 4 * std::ptrdiff_t(block.last_column)
                         : wrapped(origin + block.first_column, ring.width) - 4 * std::ptrdiff_t(block.first_column));
    }
    for (int j = 0; j < block.rows; ++j)
        for (int i = 0; i < block.columns; ++i, ++s) {
            Sum total[count];
            for (int k = 0; k < count; ++k) total[k] = zero();
            if (narrow)
                sum_columns<count, reverse>(*s, s->column, s->columns, block.weights + s->first, at, ring, flipped,
                                            total);
            else
                sum_wide<count, reverse>(*s, block.weights, instances, ring, flipped, total);
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
