#include "simd/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/distribution_bilinear.cpp"
#include <hwy/foreach_target.h>
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "simd/distribution_bilinear.h"
#include "distribution/bilinear_place.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int k_batch = 64;
constexpr double k_total = BilinearRows::k_total;

HWY_INLINE double signed_edge(std::uint32_t edge) {
    return double(std::int64_t(edge)) - 0x1p31;
}

/// A vector of edges, less 2^31.
template <class D>
HWY_INLINE hn::Vec<D> signed_edges(D d, const std::uint32_t* edges) {
    const hn::Rebind<std::int32_t, D> di;
    const hn::Rebind<std::uint32_t, D> du;
    return hn::PromoteTo(d, hn::BitCast(di, hn::Xor(hn::LoadU(du, edges), hn::Set(du, 0x80000000u))));
}

/// The first item from `from` on whose edge is over `target`.
HWY_INLINE int find_from(const std::uint32_t* edges, int from, std::uint32_t target) {
    const hn::CappedTag<std::uint32_t, 16> d;
    const auto below = hn::Set(d, target);
    for (;; from += int(hn::Lanes(d))) {
        const auto found = hn::FindFirstTrue(d, hn::Lt(below, hn::LoadU(d, edges + 1 + from)));
        if (found >= 0) return from + int(found);
    }
}

/// Two rows' edges and the shares to mix them with.
struct Mixture {
    const std::uint32_t *above_edges, *below_edges;
    double above, below;

    HWY_INLINE double edge(int i) const { return above * signed_edge(above_edges[i]) + below * signed_edge(below_edges[i]); }

    /// The segment in [first, last] in which `mass` is reached, looked for around `guess`, a vector of edges at a time.
    HWY_INLINE int find(double mass, int first, int last, int guess) const {
        const hn::CappedTag<double, 8> d;
        const int lanes = int(hn::Lanes(d));
        if (lanes > 2) {
            int start = std::clamp(guess - lanes / 2 + 1, first, last);
            const auto va = hn::Set(d, above), vb = hn::Set(d, below), vm = hn::Set(d, mass);
            for (int round = 0; round < 3; ++round) {
                const auto mixed = hn::Add(hn::Mul(va, signed_edges(d, above_edges + start)), hn::Mul(vb, signed_edges(d, below_edges + start)));
                const auto found = hn::FindFirstTrue(d, hn::Lt(vm, mixed));
                if (found > 0) return start + int(found) - 1;
                if (found == 0) {  // reached before the window
                    last = start - 1;
                    start = std::max(first, start - lanes + 1);
                } else {
                    first = start + lanes - 1;
                    start = first;
                    if (first >= last) return last;
                }
                if (first >= last) return first;
            }
        }
        while (first < last) {
            const int middle = (first + last) / 2;
            if (edge(middle + 1) > mass) last = middle;
            else first = middle + 1;
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

/// One batch's numbers between the steps.
struct Batch {
    alignas(64) double quanta[k_batch], rest[k_batch], sum_above[k_batch], sum_below[k_batch], start[k_batch], length[k_batch];
    alignas(64) double above[k_batch], below[k_batch], pdf_v[k_batch], v[k_batch];
    alignas(64) double item[k_batch], mass[k_batch], quanta_above[k_batch], quanta_below[k_batch], shape_above[k_batch], shape_below[k_batch];
    int row_above[k_batch], row_below[k_batch], first[k_batch], last[k_batch], guess[k_batch];
};

void sample_bilinear(const BilinearRows& rows, const BilinearRows& columns, const double* row_sums, const UnitPoint* points, std::size_t count, float* u,
                     float* v, float* pdf_uv) {
    const hn::ScalableTag<double> d;
    const hn::Rebind<float, decltype(d)> df;
    const int lanes = int(hn::Lanes(d));
    const std::uint32_t* row_edges = rows.edges_of(0);
    const std::uint16_t* row_guide = rows.guide_of(0);
    const int width = columns.items, height = columns.count;
    const std::uint32_t in_cell = (columns.shift == 32 ? 0u : 1u << columns.shift) - 1;
    const float cell_share = float(1 / (double(in_cell) + 1));
    const auto one = hn::Set(d, 1.0), two = hn::Set(d, 2.0), half = hn::Set(d, 0.5), tiny = hn::Set(d, 1e-300);
    Batch b{};

    for (std::size_t begin = 0; begin < count; begin += k_batch) {
        const int n = int(std::min<std::size_t>(k_batch, count - begin));
        const UnitPoint* p = points + begin;

        // Row segments: found, then solved for v.
        for (int k = 0; k < n; ++k) {
            const std::uint32_t y = p[k].y;
            // edge > (y + 1/2) (2^32 - 1) / 2^32, in integers
            const int s = find_from(row_edges, row_guide[std::uint64_t(y) >> rows.shift], y - (y >> 31));
            const RowSegment place = row_segment(s, height);
            b.row_above[k] = place.above, b.row_below[k] = place.below;
            b.start[k] = place.start, b.length[k] = place.length;
            b.sum_above[k] = row_sums[place.above], b.sum_below[k] = row_sums[place.below];
            b.quanta[k] = double(std::int64_t(row_edges[s + 1] - row_edges[s]));
            b.rest[k] = (double(std::int64_t(y)) + 0.5) * (k_total * 0x1p-32) - 0x1p31 - signed_edge(row_edges[s]);
            const std::size_t cell = std::uint64_t(p[k].x) >> columns.shift;
            hwy::Prefetch(columns.guide_of(place.above) + cell);
            hwy::Prefetch(columns.guide_of(place.below) + cell);
        }
        for (int k = 0; k < k_batch; k += lanes) {
            const auto above = hn::Load(d, b.sum_above + k), below = hn::Load(d, b.sum_below + k), quanta = hn::Mul(two, hn::Load(d, b.quanta + k));
            const auto from = hn::Mul(quanta, hn::Div(above, hn::Max(hn::Add(above, below), tiny)));
            const Segments<decltype(d)> segment{d, from, hn::Sub(quanta, from)};
            const auto t = segment.invert(hn::Load(d, b.rest + k));
            const auto length = hn::Load(d, b.length + k);
            const auto a = hn::Mul(hn::Sub(one, t), above), c = hn::Mul(t, below);
            const auto share = hn::Div(c, hn::Max(hn::Add(a, c), tiny));
            hn::Store(share, d, b.below + k);
            hn::Store(hn::Sub(one, share), d, b.above + k);
            hn::Store(hn::Mul(hn::Mul(segment.at(t), hn::Div(one, length)), hn::Set(d, height * (1 / k_total))), d, b.pdf_v + k);
            hn::Store(hn::Mul(hn::Add(hn::Load(d, b.start + k), hn::Mul(t, length)), hn::Set(d, 1.0 / height)), d, b.v + k);
        }

        // Columns: the guides bracket, and a straight line through what they say of each row guesses.
        for (int k = 0; k < n; ++k) {
            const std::size_t cell = std::uint64_t(p[k].x) >> columns.shift;
            const std::uint16_t *above = columns.guide_of(b.row_above[k]) + cell, *below = columns.guide_of(b.row_below[k]) + cell;
            const bool end = int(cell) + 1 >= columns.cells();
            const int a0 = above[0], a1 = end ? width - 1 : above[1], b0 = below[0], b1 = end ? width - 1 : below[1];
            b.first[k] = std::min(a0, b0), b.last[k] = std::max(a1, b1);
            const float t = float(std::int32_t((p[k].x & in_cell) >> 1)) * (2 * cell_share);
            const float length_a = float(a1 - a0 + 1), length_b = float(b1 - b0 + 1);
            const float weight_a = float(b.above[k]) * length_b, weight_b = float(b.below[k]) * length_a;
            const float at = (weight_a * (float(a0) + t * length_a) + weight_b * (float(b0) + t * length_b)) / (weight_a + weight_b);
            b.guess[k] = int(at);
            for (int row : {b.row_above[k], b.row_below[k]}) {
                hwy::Prefetch(columns.edges_of(row) + b.guess[k]);
                hwy::Prefetch(columns.shape_of(row) + b.guess[k]);
            }
        }
        for (int k = 0; k < n; ++k) {
            const Mixture mixture{columns.edges_of(b.row_above[k]), columns.edges_of(b.row_below[k]), b.above[k], b.below[k]};
            const double mass = (double(std::int64_t(p[k].x)) + 0.5) * (k_total * 0x1p-32) - 0x1p31;
            const int i = mixture.find(mass, b.first[k], b.last[k], b.guess[k]);
            b.item[k] = i;
            b.mass[k] = mass - mixture.edge(i);
            b.quanta_above[k] = double(std::int64_t(mixture.above_edges[i + 1] - mixture.above_edges[i]));
            b.quanta_below[k] = double(std::int64_t(mixture.below_edges[i + 1] - mixture.below_edges[i]));
            b.shape_above[k] = columns.shape_of(b.row_above[k])[i];
            b.shape_below[k] = columns.shape_of(b.row_below[k])[i];
        }

        alignas(64) float buffer[3][k_batch];
        const bool whole = n == k_batch;
        float *to_u = whole ? u + begin : buffer[0], *to_v = whole ? v + begin : buffer[1], *to_pdf = whole ? pdf_uv + begin : buffer[2];
        const auto under_one = hn::Set(df, 0x1.fffffep-1f);
        for (int k = 0; k < k_batch; k += lanes) {
            const auto shape = hn::Set(d, 1.0 / 65535);
            const auto a = hn::Mul(hn::Load(d, b.above + k), hn::Load(d, b.quanta_above + k));
            const auto c = hn::Mul(hn::Load(d, b.below + k), hn::Load(d, b.quanta_below + k));
            const auto a_begin = hn::Mul(a, hn::Mul(hn::Load(d, b.shape_above + k), shape));
            const auto c_begin = hn::Mul(c, hn::Mul(hn::Load(d, b.shape_below + k), shape));
            const auto from = hn::Mul(two, hn::Add(a_begin, c_begin));
            const Segments<decltype(d)> segment{d, from, hn::Sub(hn::Mul(two, hn::Add(a, c)), from)};
            const auto t = segment.invert(hn::Max(hn::Load(d, b.mass + k), hn::Zero(d)));
            auto x = hn::Mul(hn::Add(hn::Add(hn::Load(d, b.item + k), half), t), hn::Set(d, 1.0 / width));
            x = hn::IfThenElse(hn::Ge(x, one), hn::Sub(x, one), x);
            hn::StoreU(hn::Min(hn::DemoteTo(df, x), under_one), df, to_u + k);
            hn::StoreU(hn::Min(hn::DemoteTo(df, hn::Load(d, b.v + k)), under_one), df, to_v + k);
            const auto pdf_u = hn::Mul(segment.at(t), hn::Set(d, width * (1 / k_total)));
            hn::StoreU(hn::DemoteTo(df, hn::Mul(hn::Load(d, b.pdf_v + k), pdf_u)), df, to_pdf + k);
        }
        if (!whole) {
            std::copy_n(buffer[0], n, u + begin);
            std::copy_n(buffer[1], n, v + begin);
            std::copy_n(buffer[2], n, pdf_uv + begin);
        }
    }
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(sample_bilinear);

void sample_bilinear(const BilinearRows& rows, const BilinearRows& columns, const double* row_sums, std::span<const UnitPoint> points, float* u,
                     float* v, float* pdf_uv) {
    HWY_DYNAMIC_DISPATCH(sample_bilinear)(rows, columns, row_sums, points.data(), points.size(), u, v, pdf_uv);
}

}  // namespace domelight::simd
#endif
