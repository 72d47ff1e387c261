#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sampling/distribution/bilinear.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/cache_control.h>
#include <hwy/highway.h>
#include "base/float64-inl.h"
#include "sampling/distribution/bilinear_simd.h"
#include "sampling/distribution/float-inl.h"
#include "sampling/distribution/bilinear_place.h"
#include <algorithm>
#include <cstring>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr double k_total = BilinearRows::k_total;

/// The first item from `from` on whose end is over `target`.
HWY_INLINE int find_from(const std::int32_t* edges, int from, std::int32_t target) {
    const hn::CappedTag<std::int32_t, 16> d;
    const auto below = hn::Set(d, target);
    for (;; from += int(hn::Lanes(d))) {
        const auto found = hn::FindFirstTrue(d, hn::Lt(below, hn::LoadU(d, edges + 1 + from)));
        if (found >= 0) return from + int(found);
    }
}

constexpr int k_segments = BilinearLine::k_segments;

/// A line of one row and the same of the next, and the shares to mix them with.
struct Mixture {
    const BilinearLine &above_line, &below_line;
    double above, below;

    HWY_INLINE double edge(int k) const { return above * above_line.edges[k] + below * below_line.edges[k]; }

    /// The number of the line's segments that end at `mass` or before; -1 if it begins beyond.
    HWY_INLINE int segments_before(double mass) const {
        const hn::CappedTag<double, 8> d;
        const hn::Rebind<std::int32_t, decltype(d)> di;
        constexpr int lanes = int(hn::MaxLanes(d)), edges = k_segments + 1;
        const auto target = hn::Set(d, mass), share_a = hn::Set(d, above), share_b = hn::Set(d, below);
        const auto count = [&](int k) HWY_ATTR {
            const auto mixed = hn::Add(hn::Mul(share_a, hn::PromoteTo(d, hn::LoadU(di, above_line.edges + k))),
                                       hn::Mul(share_b, hn::PromoteTo(d, hn::LoadU(di, below_line.edges + k))));
            return int(hn::CountTrue(d, hn::Le(mixed, target)));
        };
        int before = -1, k = 0;
#pragma GCC unroll 11
        for (; k + lanes <= edges; k += lanes) before += count(k);
        // The last vector begins with edges that are counted already. The edges grow: it adds none unless it counts all
        // of those.
        if (k < edges) before += std::max(count(edges - lanes) - (k - (edges - lanes)), 0);
        return before;
    }
};

/// LinearSegment of vectors: the same operations.
template <class D>
struct Segments {
    using V = hn::Vec<D>;
    D d;
    V begin, end;
    HWY_INLINE V at(V t) const { return hn::Add(hn::Mul(begin, hn::Sub(hn::Set(d, 1.0), t)), hn::Mul(end, t)); }
    HWY_INLINE V invert(V mass) const {
        const V two = hn::Set(d, 2.0);
        const V square = hn::Add(hn::Mul(begin, begin), hn::Mul(hn::Mul(two, hn::Sub(end, begin)), mass));
        const V root = hn::Sqrt(hn::Max(square, hn::Zero(d)));
        const V t = hn::Div(hn::Mul(two, mass), hn::Max(hn::Add(begin, root), hn::Set(d, 1e-300)));
        return hn::Min(hn::Max(t, hn::Set(d, LinearSegment::k_margin)), hn::Set(d, 1 - LinearSegment::k_margin));
    }
};

/// The number of points that are processed together: two batches are under way at once, and their tables' cache lines
/// stay in the first-level cache until they are used.
constexpr int k_points = k_batch / 2;

/// The numbers of one batch between the steps. Pairs are neighbours in a table that are fetched and stored together.
struct Batch {
    const UnitPoint* points;                           ///< k_points of them
    int n;                                             ///< the number that is asked for
    UnitPoint rest[k_points];                          ///< the points of a batch that is not full
    alignas(64) std::int32_t segment[k_points];        // of the rows
    alignas(64) std::int32_t row_edges[2 * k_points];  // the quanta before and after it
    alignas(64) double begin[k_points];
    alignas(64) double above[k_points], below[k_points], pdf_v[k_points], v[k_points], mass[k_points];
    alignas(64) std::uint32_t cells[2 * k_points];  // guide cells of both rows, and their next
    alignas(64) float share[k_points];              // `below`
    alignas(64) std::int32_t line[k_points];        // in which the segment is looked for
    const BilinearLine* above_line[k_points];       // it, of the upper row
    alignas(64) std::int32_t item[k_points];        // the column segment
    alignas(64) std::int32_t above_edges[2 * k_points], below_edges[2 * k_points];
    alignas(64) std::int32_t above_shape[k_points], below_shape[k_points];
};

/// Copies two neighbours of a table, in one load and one store.
HWY_INLINE void copy_pair(const std::int32_t* from, std::int32_t* to) {
    std::memcpy(to, from, 2 * sizeof(*to));
}

/// The steps of a draw. Each ends with fetches for the next but one, so that steps of other batches can be taken in
/// between.
class Steps {
    using D = hn::ScalableTag<double>;
    using VD = hn::Vec<D>;
    using DU = hn::Rebind<std::uint32_t, D>;
    using VU = hn::Vec<DU>;
    static constexpr D d{};
    static constexpr hn::Rebind<float, D> df{};
    static constexpr hn::Rebind<std::int32_t, D> di{};
    static constexpr DU du{};
    static constexpr int lanes = int(hn::MaxLanes(D()));

  public:
    Steps(const BilinearRows& rows, const BilinearColumns& columns, const double* row_begins)
        : row_edges_(rows.edges_of(0)),
          row_guide_(rows.guide_of(0)),
          row_begins_(row_begins),
          guides_(columns.guides.data()),
          lines_(columns.lines.data()),
          guide_stride_(columns.guide_stride()),
          lines_per_row_(std::size_t(columns.lines_per_row)),
          width_(columns.items),
          height_(columns.count - 2),
          row_shift_(rows.shift),
          shift_(columns.shift),
          in_cell_((columns.shift == 32 ? 0u : 1u << columns.shift) - 1) {}

    /// Finds the points' row segments.
    HWY_INLINE void find_rows(Batch& b, const UnitPoint* points, std::size_t count) const {
        b.n = int(std::min<std::size_t>(k_points, count));
        b.points = points;
        if (b.n < k_points)
            b.points = static_cast<const UnitPoint*>(std::memcpy(b.rest, points, std::size_t(b.n) * sizeof(UnitPoint)));
        points = b.points;
        const Steps s = *this;
        const int n = b.n;
        for (int k = 0; k < n; ++k) {
            const std::uint32_t x = points[k].x, y = points[k].y;
            // edge > (y + 1/2) (2^32 - 1) / 2^32, in integers
            const int row = find_from(s.row_edges_, s.row_guide_[std::uint64_t(y) >> s.row_shift_],
                                      std::int32_t((y - (y >> 31)) ^ 0x80000000u));
            b.segment[k] = row;
            copy_pair(s.row_edges_ + row, b.row_edges + 2 * k);
            b.begin[k] = s.row_begins_[row];
            hwy::Prefetch(s.guides_ + std::size_t(row) * s.guide_stride_ + 2 * (std::uint64_t(x) >> s.shift_));
        }
    }

    /// Solves the row segments for v.
    HWY_INLINE void solve_rows(Batch& b) const {
        const Steps s = *this;
        const UnitPoint* points = b.points;
        const VD one = hn::Set(d, 1.0), two = hn::Set(d, 2.0), half = hn::Set(d, 0.5), tiny = hn::Set(d, 1e-300);
        for (int k = 0; k < k_points; k += lanes) {
            VU x, y;
            hn::LoadInterleaved2(du, &points[k].x, x, y);
            VD edge, next;
            load_pairs(b.row_edges + 2 * k, edge, next);
            const VD quanta = hn::Mul(two, hn::Sub(next, edge)), from = hn::Load(d, b.begin + k);
            const Segments<decltype(d)> segment{d, from, hn::Sub(quanta, from)};
            const VD t = segment.invert(hn::Sub(table_mass(y), edge));
            // row_segment() in vectors
            const VD row = hn::PromoteTo(d, hn::Load(di, b.segment + k));
            const VD start = hn::Max(hn::Sub(row, half), hn::Zero(d)),
                     end = hn::Min(hn::Add(row, half), hn::Set(d, double(s.height_)));
            const VD length = hn::Sub(end, start),
                     reciprocal = hn::Sub(hn::Set(d, 3.0), hn::Mul(two, length));  // of 1/2 or 1
            const VD value = segment.at(t), share = hn::Div(hn::Mul(segment.end, t), hn::Max(value, tiny));
            hn::Store(share, d, b.below + k);
            hn::Store(hn::DemoteTo(df, share), df, b.share + k);
            hn::Store(hn::Sub(one, share), d, b.above + k);
            hn::Store(hn::Mul(hn::Mul(value, reciprocal), hn::Set(d, s.height_ * (1 / k_total))), d, b.pdf_v + k);
            hn::Store(hn::Mul(hn::Add(start, hn::Mul(t, length)), hn::Set(d, 1.0 / s.height_)), d, b.v + k);
            hn::Store(table_mass(x), d, b.mass + k);
        }
    }

    /// Guesses the columns' lines: the guide cells bracket the segment, and it is interpolated linearly between them.
    HWY_INLINE void guess_lines(Batch& b) const {
        const Steps s = *this;
        const int n = b.n;
        const UnitPoint* points = b.points;
        for (int k = 0; k < n; ++k) {
            const std::uint16_t* cell =
                s.guides_ + std::size_t(b.segment[k]) * s.guide_stride_ + 2 * (std::uint64_t(points[k].x) >> s.shift_);
            std::memcpy(b.cells + 2 * k, cell, 4 * sizeof(*cell));
        }
        const hn::ScalableTag<float> wf;
        const hn::RebindToSigned<decltype(wf)> wi;
        const hn::RebindToUnsigned<decltype(wf)> wu;
        using WU = hn::Vec<decltype(wu)>;
        for (int k = 0; k < k_points; k += int(hn::Lanes(wf))) {
            const WU low = hn::Set(wu, 0xffffu);
            WU here, next, x, y;
            hn::LoadInterleaved2(wu, b.cells + 2 * k, here, next);
            hn::LoadInterleaved2(wu, &points[k].x, x, y);
            const auto to_float = [&](WU v) HWY_ATTR { return hn::ConvertTo(wf, hn::BitCast(wi, v)); };
            const auto a0 = to_float(hn::And(here, low)), b0 = to_float(hn::ShiftRight<16>(here));
            const auto a1 = to_float(hn::And(next, low)), b1 = to_float(hn::ShiftRight<16>(next));
            const auto unit = hn::Set(wf, 1.0f);
            const auto t = hn::Mul(to_float(hn::ShiftRight<1>(hn::And(x, hn::Set(wu, s.in_cell_)))),
                                   hn::Set(wf, float(2 / (double(s.in_cell_) + 1))));
            const auto from_a = hn::Add(a0, hn::Mul(t, hn::Add(hn::Sub(a1, a0), unit))),
                       from_b = hn::Add(b0, hn::Mul(t, hn::Add(hn::Sub(b1, b0), unit)));
            const auto at = hn::Add(from_a, hn::Mul(hn::Load(wf, b.share + k), hn::Sub(from_b, from_a)));
            const auto guess = hn::Min(hn::Max(at, hn::Min(a0, b0)), hn::Max(a1, b1));
            hn::Store(hn::ConvertTo(wi, hn::Mul(guess, hn::Set(wf, 1.0f / k_segments))), wi, b.line + k);
        }
        for (int k = 0; k < n; ++k) {
            const BilinearLine* line = s.lines_ + std::size_t(b.segment[k]) * s.lines_per_row_ + std::size_t(b.line[k]);
            b.above_line[k] = line;
            hwy::Prefetch(line);
            hwy::Prefetch(line + s.lines_per_row_);
        }
    }

    /// Finds the column segments.
    HWY_INLINE void search(Batch& b) const {
        const Steps s = *this;
        const int n = b.n;
        int missed[k_points], misses = 0;
        for (int k = 0; k < n; ++k) {
            const int before = s.mixture(b, k).segments_before(b.mass[k]);
            if (HWY_LIKELY(unsigned(before) < unsigned(k_segments)))
                s.copy_segment(b, k, before);
            else
                missed[misses++] = k;
        }
        // Segments outside of the lines that were guessed: the lines beside them are fetched, all together.
        for (int m = 0; m < misses; ++m) {
            const int k = missed[m];
            const int beside = s.mixture(b, k).edge(0) > b.mass[k] ? -1 : 1;
            s.move_to(b, k, std::clamp(b.line[k] + beside, 0, int(s.lines_per_row_) - 1));
            hwy::Prefetch(b.above_line[k]);
            hwy::Prefetch(b.above_line[k] + s.lines_per_row_);
        }
        for (int m = 0; m < misses; ++m) {
            const int k = missed[m], before = s.mixture(b, k).segments_before(b.mass[k]);
            if (unsigned(before) < unsigned(k_segments)) {
                s.copy_segment(b, k, before);
            } else {
                s.find_line(b, k);
                s.copy_segment(b, k, std::clamp(s.mixture(b, k).segments_before(b.mass[k]), 0, k_segments - 1));
            }
        }
    }

    /// Solves the column segments for u.
    HWY_INLINE void finish(const Batch& b, float* u, float* v, float* pdf_uv) const {
        const Steps s = *this;
        const VD one = hn::Set(d, 1.0), two = hn::Set(d, 2.0), half = hn::Set(d, 0.5);
        const BatchOutput<k_points> out(u, v, pdf_uv, b.n);
        const auto under_one = hn::Set(df, 0x1.fffffep-1f);
        for (int k = 0; k < k_points; k += lanes) {
            VD above_edge, above_next, below_edge, below_next;
            load_pairs(b.above_edges + 2 * k, above_edge, above_next);
            load_pairs(b.below_edges + 2 * k, below_edge, below_next);
            const auto above = hn::Load(d, b.above + k), below = hn::Load(d, b.below + k);
            const auto a = hn::Mul(above, hn::Sub(above_next, above_edge));
            const auto c = hn::Mul(below, hn::Sub(below_next, below_edge));
            const auto a_begin = hn::Mul(a, hn::PromoteTo(d, hn::Load(di, b.above_shape + k)));
            const auto c_begin = hn::Mul(c, hn::PromoteTo(d, hn::Load(di, b.below_shape + k)));
            const auto from = hn::Mul(hn::Add(a_begin, c_begin), hn::Set(d, 2.0 / 65535));
            const Segments<decltype(d)> segment{d, from, hn::Sub(hn::Mul(two, hn::Add(a, c)), from)};
            const auto mass =
                hn::Sub(hn::Load(d, b.mass + k), hn::Add(hn::Mul(above, above_edge), hn::Mul(below, below_edge)));
            const auto t = segment.invert(hn::Max(mass, hn::Zero(d)));
            auto x = hn::Mul(hn::Add(hn::Add(hn::PromoteTo(d, hn::Load(di, b.item + k)), half), t),
                             hn::Set(d, 1.0 / s.width_));
            x = hn::IfThenElse(hn::Ge(x, one), hn::Sub(x, one), x);
            hn::StoreU(hn::Min(hn::DemoteTo(df, x), under_one), df, out.to[0] + k);
            hn::StoreU(hn::Min(hn::DemoteTo(df, hn::Load(d, b.v + k)), under_one), df, out.to[1] + k);
            const auto pdf_u = hn::Mul(segment.at(t), hn::Set(d, s.width_ * (1 / k_total)));
            hn::StoreU(hn::DemoteTo(df, hn::Mul(hn::Load(d, b.pdf_v + k), pdf_u)), df, out.to[2] + k);
        }
        out.finish();
    }

  private:
    static HWY_INLINE void load_pairs(const std::int32_t* from, VD& before, VD& after) {
        hn::Vec<decltype(di)> low, high;
        hn::LoadInterleaved2(di, from, low, high);
        before = hn::PromoteTo(d, low), after = hn::PromoteTo(d, high);
    }
    /// (xi + 1/2) (2^32 - 1) / 2^32 - 2^31
    static HWY_INLINE VD table_mass(VU xi) {
        const VD middle = hn::Set(d, 0x1p31),
                 number = hn::Add(hn::PromoteTo(d, hn::BitCast(di, hn::Xor(xi, hn::Set(du, 0x80000000u)))), middle);
        return hn::Sub(hn::Mul(hn::Add(number, hn::Set(d, 0.5)), hn::Set(d, k_total * 0x1p-32)), middle);
    }
    HWY_INLINE Mixture mixture(const Batch& b, int k) const {
        return {b.above_line[k][0], b.above_line[k][lines_per_row_], b.above[k], b.below[k]};
    }
    HWY_INLINE void move_to(Batch& b, int k, int line) const {
        b.above_line[k] += line - b.line[k];
        b.line[k] = line;
    }
    /// Moves to the line in which the mass is reached, between those that the guide cells bracket: they are halved down.
    HWY_INLINE void find_line(Batch& b, int k) const {
        const std::uint32_t here = b.cells[2 * k], next = b.cells[2 * k + 1];
        int first = int(std::min(here & 0xffff, here >> 16)) / k_segments,
            last = int(std::max(next & 0xffff, next >> 16)) / k_segments;
        while (first < last) {
            const int middle = (first + last + 1) / 2;
            move_to(b, k, middle);
            if (mixture(b, k).edge(0) > b.mass[k])
                last = middle - 1;
            else
                first = middle;
        }
        move_to(b, k, first);
    }
    HWY_INLINE void copy_segment(Batch& b, int k, int within) const {
        const BilinearLine &above = b.above_line[k][0], &below = b.above_line[k][lines_per_row_];
        b.item[k] = b.line[k] * k_segments + within;
        copy_pair(above.edges + within, b.above_edges + 2 * k);
        copy_pair(below.edges + within, b.below_edges + 2 * k);
        b.above_shape[k] = above.shape[within];
        b.below_shape[k] = below.shape[within];
    }

    const std::int32_t* row_edges_;
    const std::uint16_t* row_guide_;
    const double* row_begins_;
    const std::uint16_t* guides_;
    const BilinearLine* lines_;
    std::size_t guide_stride_, lines_per_row_;
    int width_, height_, row_shift_, shift_;
    std::uint32_t in_cell_;
};

void sample_bilinear(const BilinearRows& rows, const BilinearColumns& columns, const double* row_begins,
                     const UnitPoint* points, std::size_t count, float* u, float* v, float* pdf_uv) {
    const Steps steps(rows, columns, row_begins);
    Batch batches[2]{};
    const std::size_t whole = (count + k_points - 1) / k_points;
    const auto find_rows = [&](std::size_t i) HWY_ATTR {
        if (i < whole) steps.find_rows(batches[i % 2], points + i * k_points, count - i * k_points);
    };
    const auto guess_lines = [&](std::size_t i) HWY_ATTR {
        if (i >= whole) return;
        steps.solve_rows(batches[i % 2]);
        steps.guess_lines(batches[i % 2]);
    };
    // While the tables' cache lines arrive that one batch asked for, the other one is at work.
    find_rows(0);
    guess_lines(0);
    find_rows(1);
    for (std::size_t i = 0; i < whole; ++i) {
        Batch& b = batches[i % 2];
        steps.search(b);
        guess_lines(i + 1);
        steps.finish(b, u + i * k_points, v + i * k_points, pdf_uv + i * k_points);
        find_rows(i + 2);
    }
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(sample_bilinear);

void sample_bilinear(const BilinearRows& rows, const BilinearColumns& columns, const double* row_begins,
                     std::span<const UnitPoint> points, float* u, float* v, float* pdf_uv) {
    HWY_DYNAMIC_DISPATCH(sample_bilinear)(rows, columns, row_begins, points.data(), points.size(), u, v, pdf_uv);
}

}  // namespace domelight::simd
#endif
