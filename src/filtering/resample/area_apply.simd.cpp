#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filtering/resample/area_apply.simd.cpp"
// clang-format off: the order is Highway's
#include "filtering/resample/area_apply.h"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <cstring>
// clang-format on

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
HWY_INLINE Sum subtract(Sum a, Sum b) {
    return {{a.rgb[0] - b.rgb[0], a.rgb[1] - b.rgb[1], a.rgb[2] - b.rgb[2]}};
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
HWY_INLINE Sum subtract(Sum a, Sum b) {
    return hn::Sub(a, b);
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
HWY_INLINE std::ptrdiff_t wrapped(int column, const RowRing& ring) {
    while (column < 0) column += ring.width;
    while (column >= ring.width) column -= ring.width;
    return ring.place(column);
}

/// The sums of up to four instances, as separate variables: arrays would be kept in memory.
struct Sums {
    Sum a, b, c, d;
};

/// Sums weights * texels of `columns` source columns; `at` is where an instance's stencil column 0 lies, so that in
/// memory its texels go on from at + 4 * column, or from at - 4 * column leftwards.
template <int count, bool reverse>
HWY_INLINE Sums sum_columns(const Stencil& s, int column, int columns, const float* w, const float* const (&at)[count],
                            const RowRing& ring, bool flipped) {
    const int mask = ring.capacity - 1;
    Sum a = zero(), b = a, c = a, d = a;
    const std::ptrdiff_t start = (reverse ? -4 : 4) * std::ptrdiff_t(column) - (reverse ? 4 * (k_texels - 1) : 0);
    for (int r = 0; r < s.rows; ++r, w += s.columns) {
        const int row = flipped ? ring.height - 1 - (s.row + r) : s.row + r;
        std::ptrdiff_t place = (row & mask) * ring.stride + start;
        for (int x = 0; x < columns; x += k_texels, place += reverse ? -4 * k_texels : 4 * k_texels) {
            const auto weight = spread<reverse>(w + x);
            a = multiply_add(weight, at[0] + place, a);
            if constexpr (count > 1) b = multiply_add(weight, at[1] + place, b);
            if constexpr (count > 2) c = multiply_add(weight, at[2] + place, c);
            if constexpr (count > 3) d = multiply_add(weight, at[3] + place, d);
        }
    }
    return {a, b, c, d};
}

/// A long sum and its rounding error.
struct LongSum {
    Sum total, lost;
};

/// Adds with compensation (Knuth's exact sum of two).
HWY_INLINE LongSum add_part(LongSum sum, Sum part) {
    const Sum next = add(sum.total, part), of_part = subtract(next, sum.total);
    const Sum error = add(subtract(sum.total, subtract(next, of_part)), subtract(part, of_part));
    return {next, add(sum.lost, error)};
}

/// A wide stencil, as for texels near a pole. It is applied in parts, each wrapped by itself, with compensated sums, so
/// that thousands of floats still keep a constant to 1e-6.
template <int count, bool reverse>
Sums sum_wide(const Stencil& s, const float* weights, const StencilInstance* instances, const RowRing& ring,
              bool flipped) {
    constexpr int part_columns = 16;
    LongSum a{zero(), zero()}, b = a, c = a, d = a;
    for (int c0 = 0; c0 < s.columns; c0 += part_columns) {
        const int columns = s.columns - c0 < part_columns ? s.columns - c0 : part_columns, column = s.column + c0;
        const float* at[count];
        for (int i = 0; i < count; ++i) {
            const int origin = instances[i].column_origin;
            at[i] = ring.data +
                    (reverse ? wrapped(origin - (column + columns - 1), ring) + 4 * std::ptrdiff_t(column + columns - 1)
                             : wrapped(origin + column, ring) - 4 * std::ptrdiff_t(column));
        }
        const Sums part = sum_columns<count, reverse>(s, column, columns, weights + s.first + c0, at, ring, flipped);
        a = add_part(a, part.a);
        b = add_part(b, part.b);
        c = add_part(c, part.c);
        d = add_part(d, part.d);
    }
    return {add(a.total, a.lost), add(b.total, b.lost), add(c.total, c.lost), add(d.total, d.lost)};
}

/// A block's texels of one instance in the order of the output. They are written at the end, in whole cache lines and
/// bypassing the caches. (Writing three floats at a time to 75 MB of cold memory takes as long as computing them.)
struct BlockPixels {
    static constexpr int k_floats = 3 * k_block_side * k_block_side;
    float* out;
    std::ptrdiff_t row_step;  ///< floats
    int row_floats, rows;
    int first, step_i, step_j;  ///< floats, in the block
};

BlockPixels block_pixels(const StencilBlock& block, const StencilInstance& instance, float* out) {
    // One of i and j runs along the output's rows.
    const bool i_along = block.columns == 1 || instance.out_i == 1 || instance.out_i == -1;
    const int along = i_along ? block.columns : block.rows, across = i_along ? block.rows : block.columns;
    const std::ptrdiff_t along_step = i_along ? instance.out_i : instance.out_j,
                         across_step = i_along ? instance.out_j : instance.out_i;
    const bool left = along_step < 0, up = across_step < 0;
    std::ptrdiff_t texel = instance.out;
    if (left) texel += (along - 1) * along_step;
    if (up) texel += (across - 1) * across_step;
    const int step = left ? -3 : 3, stride = (up ? -3 : 3) * along;
    return {out + 3 * texel,
            3 * (up ? -across_step : across_step),
            3 * along,
            across,
            (left ? 3 * (along - 1) : 0) + (up ? 3 * along * (across - 1) : 0),
            i_along ? step : stride,
            i_along ? stride : step};
}

HWY_INLINE void write_block(const BlockPixels& b, const float* pixels) {
    for (int y = 0; y < b.rows; ++y, pixels += b.row_floats) {
        float* to = b.out + y * b.row_step;
#if HWY_TARGET != HWY_SCALAR
        if (reinterpret_cast<std::uintptr_t>(to) % 64 == 0 && b.row_floats % 16 == 0) {
            const D4 d;
            for (int x = 0; x < b.row_floats; x += 4) hn::Stream(hn::LoadU(d, pixels + x), d, to + x);
            continue;
        }
#endif
        std::memcpy(to, pixels, b.row_floats * sizeof(float));
    }
}

template <int count, bool reverse>
void apply(const StencilBlock& block, const StencilInstance* instances, const RowRing& ring, bool flipped, float* out) {
    const Stencil* s = block.stencils.data();
    // If all columns of the block fit into the row and its padding, they are wrapped only once.
    const bool narrow = block.last_column - block.first_column < k_ring_padding;
    const float* at[count];
    for (int i = 0; i < count; ++i) {
        const int origin = instances[i].column_origin;
        at[i] =
            ring.data + (reverse ? wrapped(origin - block.last_column, ring) + 4 * std::ptrdiff_t(block.last_column)
                                 : wrapped(origin + block.first_column, ring) - 4 * std::ptrdiff_t(block.first_column));
    }
    // The rows are short and far apart, so hardware does not prefetch them.
    if (narrow)
        for (int row = block.first_row; row <= block.last_row; ++row) {
            const std::ptrdiff_t offset = ((flipped ? ring.height - 1 - row : row) & (ring.capacity - 1)) * ring.stride;
            for (int i = 0; i < count; ++i) {
                const float* from =
                    at[i] + offset + 4 * std::ptrdiff_t(reverse ? -block.last_column : block.first_column);
                for (int x = 0; x < 4 * (block.last_column - block.first_column + 1) + 16; x += 16)
                    hwy::Prefetch(from + x);
            }
        }
    HWY_ALIGN float pixels[count][BlockPixels::k_floats];
    BlockPixels places[count];
    for (int i = 0; i < count; ++i) places[i] = block_pixels(block, instances[i], out);
    for (int j = 0; j < block.rows; ++j)
        for (int i = 0; i < block.columns; ++i, ++s) {
            const Sums total = narrow ? sum_columns<count, reverse>(*s, s->column, s->columns, block.weights + s->first,
                                                                    at, ring, flipped)
                                      : sum_wide<count, reverse>(*s, block.weights, instances, ring, flipped);
            const auto put = [&](int k, const Sum& sum) {
                store(sum, pixels[k] + places[k].first + i * places[k].step_i + j * places[k].step_j);
            };
            put(0, total.a);
            if constexpr (count > 1) put(1, total.b);
            if constexpr (count > 2) put(2, total.c);
            if constexpr (count > 3) put(3, total.d);
        }
    for (int i = 0; i < count; ++i) write_block(places[i], pixels[i]);
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
    hwy::FlushStream();
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
