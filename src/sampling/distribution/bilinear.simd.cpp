#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sampling/distribution/bilinear.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/cache_control.h>
#include <hwy/highway.h>
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

constexpr int k_window = 8;
using W = hn::CappedTag<double, k_window>;

/// Two rows' edges and the shares to mix them with.
struct Mixture {
    const std::int32_t *above_edges, *below_edges;
    double above, below;

    HWY_INLINE double edge(int i) const { return above * above_edges[i] + below * below_edges[i]; }

    /// The first of a vector of edges from `start` on that is over `mass`, or -1.
    HWY_INLINE std::intptr_t window(double mass, int start) const {
        const W d;
        const hn::Rebind<std::int32_t, W> di;
        const auto mixed = hn::Add(hn::Mul(hn::Set(d, above), hn::PromoteTo(d, hn::LoadU(di, above_edges + start))),
                                   hn::Mul(hn::Set(d, below), hn::PromoteTo(d, hn::LoadU(di, below_edges + start))));
        return hn::FindFirstTrue(d, hn::Lt(hn::Set(d, mass), mixed));
    }

    /// The segment in which `mass` is reached, given `start`, a little before it: nearly always among the vector of
    /// edges that begins there. If not, it is halved down from what the two rows' guide cells (each: first column, last
    /// column) bracket.
    HWY_INLINE int find(double mass, int start, std::uint32_t above_cell, std::uint32_t below_cell) const {
        const W d;
        const int lanes = int(hn::Lanes(d));
        const auto from = window(mass, start);
        if (HWY_LIKELY(from > 0)) return start + int(from) - 1;
        int first = int(std::min(above_cell & 0xffff, below_cell & 0xffff)),
            last = int(std::max(above_cell >> 16, below_cell >> 16));
        if (lanes > 2) {
            if (from == 0)
                last = start - 1, start = std::max(first, start - lanes + 1);
            else
                first = start += lanes - 1;
            if (first >= last) return first;
            const auto again = window(mass, start);
            if (again > 0) return start + int(again) - 1;
            if (again == 0)
                last = start - 1;
            else
                first = start + lanes - 1;
        }
        while (first < last) {
            const int middle = (first + last) / 2;
            if (edge(middle + 1) > mass)
                last = middle;
            else
                first = middle + 1;
        }
        return first;
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

/// The numbers of one batch between the steps. Pairs are neighbours in a table that are fetched and stored together.
struct Batch {
    alignas(64) std::int32_t segment[k_batch];        // of the rows
    alignas(64) std::int32_t row_edges[2 * k_batch];  // the quanta before and after it
    alignas(64) double begin[k_batch];
    alignas(64) double above[k_batch], below[k_batch], pdf_v[k_batch], v[k_batch], mass[k_batch];
    alignas(64) std::uint32_t above_cell[k_batch], below_cell[k_batch];  // guide cells and their next
    alignas(64) std::int32_t start[k_batch];                             // of the window of columns to search
    alignas(64) std::int32_t item[k_batch];                              // the column segment
    alignas(64) std::int32_t above_edges[2 * k_batch], below_edges[2 * k_batch];
    alignas(64) std::int32_t above_shape[k_batch], below_shape[k_batch];
};

/// Copies two neighbours of a table, in one load and one store.
HWY_INLINE void copy_pair(const std::int32_t* from, std::int32_t* to) {
    std::memcpy(to, from, 2 * sizeof(*to));
}

/// Two neighbours of a guide: the first in the lower half.
HWY_INLINE std::uint32_t guide_pair(const std::uint16_t* guide) {
    return std::uint32_t(guide[0]) | std::uint32_t(guide[1]) << 16;
}

void sample_bilinear(const BilinearRows& rows, const BilinearRows& columns, const double* row_begins,
                     const UnitPoint* points, std::size_t count, float* u, float* v, float* pdf_uv) {
    const hn::ScalableTag<double> d;
    const hn::Rebind<float, decltype(d)> df;
    const hn::Rebind<std::int32_t, decltype(d)> di;
    const hn::Rebind<std::uint32_t, decltype(d)> du;
    using VD = hn::Vec<decltype(d)>;
    using VU = hn::Vec<decltype(du)>;
    const int lanes = int(hn::Lanes(d));
    const std::int32_t* row_edges = rows.edges_of(0);
    const std::uint16_t* row_guide = rows.guide_of(0);
    const int width = columns.items, height = columns.count - 2, row_shift = rows.shift, shift = columns.shift;
    const std::int32_t* edges = columns.edges.data();
    const std::uint16_t *shapes = columns.shape.data(), *guides = columns.guide.data();
    const std::size_t edge_stride = std::size_t(width) + 1, shape_stride = std::size_t(width),
                      guide_stride = std::size_t(columns.cells()) + 8;
    const std::uint32_t in_cell = (shift == 32 ? 0u : 1u << shift) - 1;
    const VD one = hn::Set(d, 1.0), two = hn::Set(d, 2.0), half = hn::Set(d, 0.5), tiny = hn::Set(d, 1e-300),
             middle = hn::Set(d, 0x1p31);
    const auto load_pairs = [&](const std::int32_t* from, VD& before, VD& after) HWY_ATTR {
        hn::Vec<decltype(di)> low, high;
        hn::LoadInterleaved2(di, from, low, high);
        before = hn::PromoteTo(d, low), after = hn::PromoteTo(d, high);
    };
    // (xi + 1/2) (2^32 - 1) / 2^32 - 2^31
    const auto table_mass = [&](VU xi) HWY_ATTR {
        const VD number = hn::Add(hn::PromoteTo(d, hn::BitCast(di, hn::Xor(xi, hn::Set(du, 0x80000000u)))), middle);
        return hn::Sub(hn::Mul(hn::Add(number, half), hn::Set(d, k_total * 0x1p-32)), middle);
    };
    Batch b{};
    UnitPoint rest[k_batch] = {};

    for (std::size_t begin = 0; begin < count; begin += k_batch) {
        const int n = int(std::min<std::size_t>(k_batch, count - begin));
        const UnitPoint* p = points + begin;
        if (n < k_batch) p = static_cast<const UnitPoint*>(std::memcpy(rest, p, n * sizeof(UnitPoint)));

        // Row segments: found, then solved for v.
        for (int k = 0; k < n; ++k) {
            const std::uint32_t x = p[k].x, y = p[k].y;
            // edge > (y + 1/2) (2^32 - 1) / 2^32, in integers
            const int s = find_from(row_edges, row_guide[std::uint64_t(y) >> row_shift],
                                    std::int32_t((y - (y >> 31)) ^ 0x80000000u));
            b.segment[k] = s;
            copy_pair(row_edges + s, b.row_edges + 2 * k);
            b.begin[k] = row_begins[s];
            const std::uint16_t* cell = guides + std::size_t(s) * guide_stride + (std::uint64_t(x) >> shift);
            hwy::Prefetch(cell);
            hwy::Prefetch(cell + guide_stride);
        }
        for (int k = 0; k < k_batch; k += lanes) {
            VU x, y;
            hn::LoadInterleaved2(du, &p[k].x, x, y);
            VD edge, next;
            load_pairs(b.row_edges + 2 * k, edge, next);
            const VD quanta = hn::Mul(two, hn::Sub(next, edge)), from = hn::Load(d, b.begin + k);
            const Segments<decltype(d)> segment{d, from, hn::Sub(quanta, from)};
            const VD t = segment.invert(hn::Sub(table_mass(y), edge));
            // row_segment() in vectors
            const VD s = hn::PromoteTo(d, hn::Load(di, b.segment + k));
            const VD start = hn::Max(hn::Sub(s, half), hn::Zero(d)),
                     end = hn::Min(hn::Add(s, half), hn::Set(d, double(height)));
            const VD length = hn::Sub(end, start),
                     reciprocal = hn::Sub(hn::Set(d, 3.0), hn::Mul(two, length));  // of 1/2 or 1
            const VD value = segment.at(t), share = hn::Div(hn::Mul(segment.end, t), hn::Max(value, tiny));
            hn::Store(share, d, b.below + k);
            hn::Store(hn::Sub(one, share), d, b.above + k);
            hn::Store(hn::Mul(hn::Mul(value, reciprocal), hn::Set(d, height * (1 / k_total))), d, b.pdf_v + k);
            hn::Store(hn::Mul(hn::Add(start, hn::Mul(t, length)), hn::Set(d, 1.0 / height)), d, b.v + k);
            hn::Store(table_mass(x), d, b.mass + k);
        }

        // Columns: the guide cells bracket the segment, and linear interpolation between them gives the first guess.
        for (int k = 0; k < n; ++k) {
            const std::uint16_t* cell =
                guides + std::size_t(b.segment[k]) * guide_stride + (std::uint64_t(p[k].x) >> shift);
            b.above_cell[k] = guide_pair(cell);  // past the last cell there is a last column
            b.below_cell[k] = guide_pair(cell + guide_stride);
        }
        for (int k = 0; k < k_batch; k += lanes) {
            const VU low = hn::Set(du, 0xffffu), above = hn::Load(du, b.above_cell + k),
                     below = hn::Load(du, b.below_cell + k);
            const auto a0 = hn::BitCast(di, hn::And(above, low)), a1 = hn::BitCast(di, hn::ShiftRight<16>(above));
            const auto b0 = hn::BitCast(di, hn::And(below, low)), b1 = hn::BitCast(di, hn::ShiftRight<16>(below));
            const auto first = hn::Min(a0, b0), last = hn::Max(a1, b1);
            const auto fa = hn::ConvertTo(df, a0), fb = hn::ConvertTo(df, b0), unit = hn::Set(df, 1.0f);
            const auto length_a = hn::Add(hn::ConvertTo(df, hn::Sub(a1, a0)), unit),
                       length_b = hn::Add(hn::ConvertTo(df, hn::Sub(b1, b0)), unit);
            VU x, y;
            hn::LoadInterleaved2(du, &p[k].x, x, y);
            const auto place = hn::BitCast(di, hn::ShiftRight<1>(hn::And(x, hn::Set(du, in_cell))));
            const auto t = hn::Mul(hn::ConvertTo(df, place), hn::Set(df, float(2 / (double(in_cell) + 1))));
            const auto from_a = hn::Add(fa, hn::Mul(t, length_a)), from_b = hn::Add(fb, hn::Mul(t, length_b));
            const auto at =
                hn::Add(from_a, hn::Mul(hn::DemoteTo(df, hn::Load(d, b.below + k)), hn::Sub(from_b, from_a)));
            const auto start = hn::Sub(hn::ConvertTo(di, at), hn::Set(di, int(hn::Lanes(W())) / 2 - 1));
            hn::Store(hn::Max(hn::Min(start, last), first), di, b.start + k);
        }
        for (int k = 0; k < n; ++k) {
            const std::size_t row = std::size_t(b.segment[k]);
            const std::int32_t* window = edges + row * edge_stride + b.start[k];
            const std::uint16_t* shape = shapes + row * shape_stride + b.start[k] + (k_window / 2 - 1);
            hwy::Prefetch(window);
            hwy::Prefetch(window + (k_window - 1));
            hwy::Prefetch(window + edge_stride);
            hwy::Prefetch(window + edge_stride + (k_window - 1));
            hwy::Prefetch(shape);
            hwy::Prefetch(shape + shape_stride);
        }
        for (int k = 0; k < n; ++k) {
            const std::size_t row = std::size_t(b.segment[k]);
            const std::int32_t* above = edges + row * edge_stride;
            const Mixture mixture{above, above + edge_stride, b.above[k], b.below[k]};
            const int i = mixture.find(b.mass[k], b.start[k], b.above_cell[k], b.below_cell[k]);
            b.item[k] = i;
            copy_pair(above + i, b.above_edges + 2 * k);
            copy_pair(above + edge_stride + i, b.below_edges + 2 * k);
            const std::uint16_t* shape = shapes + row * shape_stride + i;
            b.above_shape[k] = shape[0];
            b.below_shape[k] = shape[shape_stride];
        }

        const BatchOutput out(u + begin, v + begin, pdf_uv + begin, n);
        const auto under_one = hn::Set(df, 0x1.fffffep-1f);
        for (int k = 0; k < k_batch; k += lanes) {
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
            auto x =
                hn::Mul(hn::Add(hn::Add(hn::PromoteTo(d, hn::Load(di, b.item + k)), half), t), hn::Set(d, 1.0 / width));
            x = hn::IfThenElse(hn::Ge(x, one), hn::Sub(x, one), x);
            hn::StoreU(hn::Min(hn::DemoteTo(df, x), under_one), df, out.to[0] + k);
            hn::StoreU(hn::Min(hn::DemoteTo(df, hn::Load(d, b.v + k)), under_one), df, out.to[1] + k);
            const auto pdf_u = hn::Mul(segment.at(t), hn::Set(d, width * (1 / k_total)));
            hn::StoreU(hn::DemoteTo(df, hn::Mul(hn::Load(d, b.pdf_v + k), pdf_u)), df, out.to[2] + k);
        }
        out.finish();
    }
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(sample_bilinear);

void sample_bilinear(const BilinearRows& rows, const BilinearRows& columns, const double* row_begins,
                     std::span<const UnitPoint> points, float* u, float* v, float* pdf_uv) {
    HWY_DYNAMIC_DISPATCH(sample_bilinear)(rows, columns, row_begins, points.data(), points.size(), u, v, pdf_uv);
}

}  // namespace domelight::simd
#endif
