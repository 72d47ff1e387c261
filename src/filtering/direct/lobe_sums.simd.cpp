#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filtering/direct/lobe_sums.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include "filtering/direct/lobe_sums.h"

#include <algorithm>
#include <cmath>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

/// sin² of x in [−π/2, π/2], to 1e-5.
HWY_INLINE V sine_squared(V x) {
    const D d;
    const V x2 = hn::Mul(x, x);
    V p = hn::MulAdd(x2, hn::Set(d, 1 / 362880.f), hn::Set(d, -1 / 5040.f));
    p = hn::MulAdd(x2, p, hn::Set(d, 1 / 120.f));
    p = hn::MulAdd(x2, p, hn::Set(d, -1 / 6.f));
    const V s = hn::Mul(x, hn::MulAdd(x2, p, hn::Set(d, 1.f)));
    return hn::Mul(s, s);
}

/// Chords from a lobe's axis to points of one row.
class RowChords {
  public:
    RowChords(const LobeAxis& axis, const Colatitude& row)
        : whole_(float(std::floor(axis.x))),
          fraction_(float(axis.x - std::floor(axis.x))),
          columns_(axis.columns),
          half_angle_(float(std::numbers::pi) / axis.columns) {
        const double across = row.sin_half * axis.at.cos_half - row.cos_half * axis.at.sin_half;
        down_ = float(4 * across * across);
        around_ = 4 * row.sin * axis.at.sin;
    }
    /// Columns from the axis, in [−columns / 2, columns / 2].
    HWY_INLINE V offset(V x) const {
        const D d;
        const V t = hn::Sub(hn::Sub(x, hn::Set(d, whole_)), hn::Set(d, fraction_));
        return hn::NegMulAdd(hn::Set(d, columns_), hn::Round(hn::Mul(t, hn::Set(d, 1 / columns_))), t);
    }
    /// s² = 4 sin²(Δθ/2) + 4 sin θ sin θ₀ sin²(Δφ/2), from the offset.
    HWY_INLINE V squared(V offset) const {
        const D d;
        return hn::MulAdd(hn::Set(d, around_), sine_squared(hn::Mul(offset, hn::Set(d, half_angle_))),
                          hn::Set(d, down_));
    }
    float down() const { return down_; }

  private:
    float whole_, fraction_, columns_, half_angle_, down_, around_;
};

/// A sum of texels in the lanes of vectors.
struct LaneSum {
    V r, g, b, weight;
    static HWY_INLINE LaneSum zero() {
        const V z = hn::Zero(D());
        return {z, z, z, z};
    }
    HWY_INLINE void add(V w, V red, V green, V blue, V width) {
        r = hn::MulAdd(w, red, r);
        g = hn::MulAdd(w, green, g);
        b = hn::MulAdd(w, blue, b);
        weight = hn::MulAdd(w, width, weight);
    }
    HWY_INLINE void add(const LaneSum& part) {
        r = hn::Add(r, part.r);
        g = hn::Add(g, part.g);
        b = hn::Add(b, part.b);
        weight = hn::Add(weight, part.weight);
    }
    HWY_INLINE LobeSum total() const {
        const D d;
        const auto sum = [d](V v) { return double(hn::GetLane(hn::SumOfLanes(d, v))); };
        return {sum(r), sum(g), sum(b), sum(weight)};
    }
};

LobeSum sum_cells(const CellRows& rows, const CellBox& box, const LobeAxis& axis) {
    const D d;
    const int lanes = int(hn::Lanes(d));
    const V one = hn::Set(d, 1.f), b2 = hn::Set(d, axis.b2);
    LaneSum sum = LaneSum::zero();
    for (int y = box.row_begin; y < box.row_end; ++y) {
        const Colatitude& place = rows.places[y];
        const RowChords chords(axis, place);
        const bool in_hole = y >= box.hole_row_begin && y < box.hole_row_end;
        const V hole_begin = hn::Set(d, in_hole ? box.hole_begin : 0.f),
                hole_end = hn::Set(d, in_hole ? box.hole_end : 0.f), row_weight = hn::Set(d, place.weight);
        // K_θθ + sin²θ K_φφ/sin²θ of q⁻², q = s² + b²: q⁻² (24 (s_θ² + σ s_φ²)/q² − 4 (1 + σ)/q), σ = sin²θ.
        const float sigma = place.sin * place.sin;
        const V c1 = hn::Set(d, -4 * (1 + sigma) * rows.curvature),
                c2 = hn::Set(d, 24 * (1 - sigma) * chords.down() * rows.curvature),
                c3 = hn::Set(d, 24 * sigma * rows.curvature);
        const float* red = rows.planes + 4 * rows.stride * (y - rows.first_row);
        // Each row by itself first: thousands of small terms on one large sum would lose their last digits.
        LaneSum line = LaneSum::zero();
        for (int k = 0; k < 2; ++k)
            for (int i = box.begin[k]; i < box.end[k]; i += lanes) {
                const V offset = chords.offset(hn::LoadU(d, rows.x + i));
                const V s2 = chords.squared(offset), inverse = hn::Div(one, hn::Add(s2, b2)),
                        cosine = hn::Max(hn::NegMulAdd(hn::Set(d, 0.5f), s2, one), hn::Zero(d));
                const V size = hn::MulAdd(inverse, hn::MulAdd(inverse, hn::MulAdd(c3, s2, c2), c1), one);
                V w = hn::Mul(hn::Mul(hn::Mul(inverse, inverse), hn::Mul(cosine, size)), row_weight);
                const auto hidden = hn::And(hn::Ge(offset, hole_begin), hn::Lt(offset, hole_end));
                w = hn::IfThenZeroElse(hidden, w);
                if (i + lanes > box.end[k]) w = hn::IfThenElseZero(hn::FirstN(d, std::size_t(box.end[k] - i)), w);
                const float* p = red + i;
                line.add(w, hn::LoadU(d, p), hn::LoadU(d, p + rows.stride), hn::LoadU(d, p + 2 * rows.stride),
                         hn::LoadU(d, p + 3 * rows.stride));
            }
        sum.add(line);
    }
    return sum.total();
}

LobeSum sum_patches(const PatchRow& row, const PatchColumns& columns, const LobeAxis& axis) {
    constexpr float node[3] = {0.11270167f, 0.5f, 0.88729833f}, share[3] = {5 / 18.f, 8 / 18.f, 5 / 18.f};
    const D d;
    const int lanes = int(hn::Lanes(d)), patches = columns.count + !columns.all_around;
    const V one = hn::Set(d, 1.f), zero = hn::Zero(d), b2 = hn::Set(d, axis.b2);
    LaneSum sum = LaneSum::zero();
    for (int n = 0; n < 3; ++n) {
        const Colatitude& place = row.nodes[n];
        const RowChords chords(axis, place);
        const V row_weight = hn::Set(d, place.weight);
        const V upper = hn::Set(d, row.use_upper ? 1 - node[n] : 0), lower = hn::Set(d, row.use_lower ? node[n] : 0);
        const V present = hn::Add(upper, lower);
        LaneSum line = LaneSum::zero();
        for (int i = 0; i < patches; i += lanes) {
            // Between the texels left and right of the patch, which do not count outside the box.
            auto has_left = hn::FirstN(d, std::size_t(lanes)), has_right = has_left;
            if (!columns.all_around) {
                if (i == 0) has_left = hn::Not(hn::FirstN(d, 1));
                has_right = hn::FirstN(d, std::size_t(std::clamp(columns.count - i, 0, lanes)));
            }
            const auto inside = hn::FirstN(d, std::size_t(std::min(patches - i, lanes)));
            V left[4], across[4];
            for (int c = 0; c < 3; ++c) {
                const float *a = row.upper + c * columns.stride + i, *b = row.lower + c * columns.stride + i;
                left[c] = hn::IfThenElseZero(has_left,
                                             hn::MulAdd(upper, hn::LoadU(d, a), hn::Mul(lower, hn::LoadU(d, b))));
                const V right = hn::IfThenElseZero(
                    has_right, hn::MulAdd(upper, hn::LoadU(d, a + 1), hn::Mul(lower, hn::LoadU(d, b + 1))));
                across[c] = hn::Sub(right, left[c]);
            }
            left[3] = hn::IfThenElseZero(has_left, present);
            across[3] = hn::Sub(hn::IfThenElseZero(has_right, present), left[3]);
            // The first patch ends at the middle of texel `first`.
            const V x = hn::Add(hn::Iota(d, float(i)), hn::Set(d, float(columns.first) - 0.5f));
            for (int m = 0; m < 3; ++m) {
                const V at = hn::Set(d, node[m]), s2 = chords.squared(chords.offset(hn::Add(x, at)));
                const V inverse = hn::Div(one, hn::Add(s2, b2)),
                        cosine = hn::Max(hn::NegMulAdd(hn::Set(d, 0.5f), s2, one), zero);
                const V lobe = hn::Mul(hn::Mul(inverse, inverse), hn::Mul(cosine, row_weight));
                const V w = hn::IfThenElseZero(inside, hn::Mul(lobe, hn::Set(d, share[m])));
                line.add(w, hn::MulAdd(at, across[0], left[0]), hn::MulAdd(at, across[1], left[1]),
                         hn::MulAdd(at, across[2], left[2]), hn::MulAdd(at, across[3], left[3]));
            }
        }
        sum.add(line);
    }
    return sum.total();
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(sum_cells);
HWY_EXPORT(sum_patches);

LobeSum sum_cells(const CellRows& rows, const CellBox& box, const LobeAxis& axis) {
    return HWY_DYNAMIC_DISPATCH(sum_cells)(rows, box, axis);
}

LobeSum sum_patches(const PatchRow& row, const PatchColumns& columns, const LobeAxis& axis) {
    return HWY_DYNAMIC_DISPATCH(sum_patches)(row, columns, axis);
}

}  // namespace domelight::simd
#endif
