#include "domelight/sampling/distribution/bilinear.h"

#include "sampling/distribution/bilinear_place.h"
#include "sampling/distribution/bilinear_simd.h"
#include "sampling/distribution/quanta.h"
#include "sampling/distribution/weight_rows.h"

#include <bit>
#include <cassert>

namespace domelight {

// ---- tables

namespace {

std::int32_t signed_quanta(std::uint64_t quanta) {
    return std::int32_t(std::int64_t(quanta) - (std::int64_t(1) << 31));
}

}  // namespace

BilinearRows::BilinearRows(int count_, int items_) : count(count_), items(items_) {
    shift = 32 - (int(std::bit_width(unsigned(items))) - 1);  // the largest power of two up to the number of items
    edges.resize(std::size_t(count) * (items + 1) + 16);
    shape.resize(std::size_t(count) * items);
    guide.resize(std::size_t(count) * (cells() + 8));
    std::fill_n(edges.end() - 16, 16, signed_quanta(k_total));  // whole vectors are read
}

void BilinearRows::fill(int row, std::span<const double> begins, std::span<const double> ends) {
    std::int32_t* e = edges.data() + std::size_t(row) * (items + 1);
    std::uint16_t *s = shape.data() + std::size_t(row) * items, *g = guide.data() + std::size_t(row) * (cells() + 8);
    std::vector<double> sums(items);
    double sum = 0;
    for (int i = 0; i < items; ++i) {
        const double both = begins[i] + ends[i];
        sums[i] = sum += both;
        // If no end is zero, no end of the shape may be zero either, because radiance / density would be unbounded
        // there.
        const double r = both > 0 ? begins[i] / both * 65535 + 0.5 : 32768;
        const int least = begins[i] > 0, most = 65535 - (ends[i] > 0);
        s[i] = std::uint16_t(std::clamp(int(r), std::min(least, most), most));
    }
    std::size_t filled = 0;
    e[0] = signed_quanta(0);
    share_quanta([&](int i) { return begins[i] + ends[i] > 0; }, sums, k_total,
                 [&](int i, std::uint64_t end) {
                     e[i + 1] = signed_quanta(end);
                     const std::size_t cells_begun = (end >> shift) + 1;
                     for (std::size_t k = 0; k < 8; ++k) g[filled + k] = std::uint16_t(i);
                     for (std::size_t k = filled + 8; k < cells_begun; ++k) g[k] = std::uint16_t(i);
                     filled = cells_begun;
                 });
    g[cells()] = std::uint16_t(items - 1);  // the next cell's item bounds a search, also in the last cell
}

void BilinearRows::fill_uniform(int row) {
    const std::vector<double> ones(items, 1.0);
    fill(row, ones, ones);
}

BilinearColumns::BilinearColumns(int count_, int items_) : count(count_), items(items_) {
    lines_per_row = (items + BilinearLine::k_segments - 1) / BilinearLine::k_segments;
    const int bits = std::max(0, int(std::bit_width(unsigned(items))) - 3);
    shift = 32 - bits;
    lines.resize(std::size_t(count) * lines_per_row);
    guides.resize(std::size_t(count - 1) * guide_stride());
}

void BilinearColumns::set(int r, const BilinearRows& from) {
    const std::int32_t* edges = from.edges_of(0);
    const std::uint16_t *shape = from.shape_of(0), *guide = from.guide_of(0);
    for (int n = 0; n < lines_per_row; ++n) {
        BilinearLine& line = lines[std::size_t(r) * lines_per_row + n];
        const int first = n * BilinearLine::k_segments;
        for (int k = 0; k <= BilinearLine::k_segments; ++k) line.edges[k] = edges[std::min(first + k, items)];
        for (int k = 0; k < BilinearLine::k_segments; ++k)
            line.shape[k] = first + k < items ? shape[first + k] : std::uint16_t(0);
    }
    const int step = from.cells() / cells();
    for (const int side : {0, 1}) {  // as the upper and as the lower row of a pair
        const int s = r - side;
        if (s < 0 || s >= count - 1) continue;
        std::uint16_t* to = guides.data() + std::size_t(s) * guide_stride() + side;
        for (int c = 0; c <= cells(); ++c) to[2 * c] = guide[std::size_t(c) * step];
    }
}

// ---- the density

namespace {

constexpr double k_total = BilinearRows::k_total;
/// xi on the tables' scale, less 2^31 as they are.
double table_mass(std::uint32_t xi) {
    return (xi + 0.5) * (k_total * 0x1p-32) - 0x1p31;
}

/// The mixture of two rows at some v, on the tables' scale.
struct Mixture {
    const BilinearLine *above_lines, *below_lines;
    double above, below;  // shares, together 1

    /// The value at the beginning (0) or the end (1) of segment i.
    double edge(int i, int end) const {
        const int line = i / BilinearLine::k_segments, k = i % BilinearLine::k_segments + end;
        return above * above_lines[line].edges[k] + below * below_lines[line].edges[k];
    }
    LinearSegment segment(int i) const {
        const int k = i % BilinearLine::k_segments;
        const BilinearLine &x = above_lines[i / BilinearLine::k_segments],
                           &y = below_lines[i / BilinearLine::k_segments];
        const double a = above * (double(x.edges[k + 1]) - x.edges[k]),
                     b = below * (double(y.edges[k + 1]) - y.edges[k]);
        const double begin = (a * x.shape[k] + b * y.shape[k]) * (2.0 / 65535);
        return {begin, 2 * (a + b) - begin};
    }
};

/// The values that depend on v alone.
struct Row {
    double v, pdf_v;
    Mixture mixture;
    int above;  ///< row of the table; the other one is the next
};

struct Tables {
    const BilinearRows& rows;
    const BilinearColumns& columns;
    const std::vector<double>& begins;
    int height() const { return columns.count - 2; }

    LinearSegment marginal_segment(int s) const { return {begins[s], 2 * rows.quanta(0, s) - begins[s]}; }

    Row at(int s, double t) const {
        const RowSegment place = row_segment(s, height());
        // The segment runs from the sum of one row to that of the next, so the lower row's share is its part of the
        // value.
        const LinearSegment segment = marginal_segment(s);
        const double value = segment.at(t), below = segment.end * t / std::max(value, 1e-300);
        const double pdf_v = value * (1 / place.length) * (height() * (1 / k_total));
        return {(place.start + t * place.length) * (1.0 / height()),
                pdf_v,
                {columns.row(s), columns.row(s + 1), 1 - below, below},
                s};
    }

    /// Draws v.
    Row draw(std::uint32_t xi) const {
        const std::int32_t* e = rows.edges_of(0);
        const double mass = table_mass(xi);
        int s = rows.guide_of(0)[std::uint64_t(xi) >> rows.shift];
        while (e[s + 1] <= mass) ++s;
        return at(s, marginal_segment(s).invert(mass - e[s]));
    }

    /// The segment of the mixture in which `mass` is reached.
    int find(const Row& row, std::uint32_t xi, double mass) const {
        const std::uint16_t* cell = columns.guide_of(row.above, xi);
        int first = std::min(cell[0], cell[1]), last = std::max(cell[2], cell[3]);
        while (first < last) {
            const int middle = (first + last) / 2;
            if (row.mixture.edge(middle, 1) > mass)
                last = middle;
            else
                first = middle + 1;
        }
        return first;
    }

    /// v's segment and the position in it.
    std::pair<int, double> place(double v) const {
        const int s = row_segment_at(v, height());
        const RowSegment p = row_segment(s, height());
        return {s, std::clamp((std::clamp(v, 0.0, 1.0) * height() - p.start) / p.length, 0.0, 1.0)};
    }
};

void prefetch(const void* address) {
#if defined(__GNUC__)
    __builtin_prefetch(address);
#else
    (void)address;
#endif
}

/// u's place among `items` segments from centre to centre.
std::pair<int, double> column_place(double u, int items) {
    double x = (u > 0 ? std::min(u, 1.0) : 0.0) * items - 0.5;
    if (x < 0) x += items;
    const int i = std::min(int(x), items - 1);
    return {i, std::clamp(x - i, 0.0, 1.0)};
}

}  // namespace

Result<BilinearDistribution> BilinearDistribution::build(const Weights& weights, int threads) {
    BilinearDistribution d;
    const int w = std::max(0, weights.width), h = std::max(0, weights.height);
    if (w > 0 && h > 0 && w <= 65535 && h <= 65535) d.columns_ = BilinearColumns(h + 2, w);
    std::vector<double> row_sums(h + 2);
    const auto add = [&](int y, std::span<const float> row, std::span<const double> sums) {
        row_sums[y + 1] = sums.back();
        BilinearRows filled(1, w);
        if (sums.back() == 0) {
            filled.fill_uniform(0);
        } else {
            std::vector<double> nodes(w + 1);
            std::copy(row.begin(), row.end(), nodes.begin());
            nodes[w] = nodes[0];
            filled.fill(0, std::span(nodes).first(w), std::span(nodes).last(w));
        }
        // The first and the last row twice.
        d.columns_.set(y + 1, filled);
        if (y == 0) d.columns_.set(0, filled);
        if (y == h - 1) d.columns_.set(h + 1, filled);
    };
    if (auto read = for_each_weight_row(weights, threads, add); !read) return read.error();
    for (auto [from, to] : {std::pair{1, 0}, {h, h + 1}}) row_sums[to] = row_sums[from];

    std::vector<double> begins(h + 1), ends(h + 1);
    double total = 0;
    for (int s = 0; s <= h; ++s) {
        const double length = row_segment(s, h).length;
        begins[s] = row_sums[s] * length;
        ends[s] = row_sums[s + 1] * length;
        total += begins[s] + ends[s];
    }
    if (total == 0) return build(uniform_weights(w, h), threads);
    d.rows_ = BilinearRows(1, h + 1);
    d.rows_.fill(0, begins, ends);
    d.row_begins_.resize(h + 1);
    for (int s = 0; s <= h; ++s) {
        const double both = begins[s] + ends[s];
        d.row_begins_[s] = both > 0 ? 2 * d.rows_.quanta(0, s) * (begins[s] / both) : 0;
    }
    return d;
}

DistributionSample BilinearDistribution::sample(UnitPoint point) const {
    const Tables tables{rows_, columns_, row_begins_};
    const Row row = tables.draw(point.y);
    const double mass = table_mass(point.x);
    const int i = tables.find(row, point.x, mass);
    const LinearSegment segment = row.mixture.segment(i);
    const double t = segment.invert(std::max(mass - row.mixture.edge(i, 0), 0.0));
    double u = (i + 0.5 + t) * (1.0 / width());
    if (u >= 1) u -= 1;
    const double pdf_u = segment.at(t) * (width() * (1 / k_total));
    return {u, std::min(row.v, 1 - 0x1p-53), row.pdf_v * pdf_u};
}

void BilinearDistribution::sample(std::span<const UnitPoint> points, std::span<float> u, std::span<float> v,
                                  std::span<float> pdf_uv) const {
    assert(u.size() == points.size() && v.size() == points.size() && pdf_uv.size() == points.size());
    simd::sample_bilinear(rows_, columns_, row_begins_.data(), points, u.data(), v.data(), pdf_uv.data());
}

double BilinearDistribution::pdf_uv(double u, double v) const {
    const Tables tables{rows_, columns_, row_begins_};
    const auto [s, t] = tables.place(v);
    const auto [i, r] = column_place(u, width());
    const Row row = tables.at(s, t);
    return row.pdf_v * row.mixture.segment(i).at(r) * (width() * (1 / k_total));
}

void BilinearDistribution::pdfs_uv(std::span<const float> u, std::span<const float> v, std::span<float> pdf_uv) const {
    assert(u.size() == v.size() && u.size() == pdf_uv.size());
    constexpr std::size_t k_block = 64;
    const Tables tables{rows_, columns_, row_begins_};
    struct Place {
        int s, i;
        double t, r;
    } places[k_block];
    for (std::size_t first = 0; first < u.size(); first += k_block) {
        const std::size_t n = std::min(k_block, u.size() - first);
        // Fetched for the whole block before any is used, so that the block's cache misses overlap.
        for (std::size_t k = 0; k < n; ++k) {
            const auto [s, t] = tables.place(v[first + k]);
            const auto [i, r] = column_place(u[first + k], width());
            places[k] = {s, i, t, r};
            for (int row = s; row <= s + 1; ++row) prefetch(columns_.row(row) + i / BilinearLine::k_segments);
        }
        for (std::size_t k = 0; k < n; ++k) {
            const Row row = tables.at(places[k].s, places[k].t);
            pdf_uv[first + k] =
                float(row.pdf_v * row.mixture.segment(places[k].i).at(places[k].r) * (width() * (1 / k_total)));
        }
    }
}

std::optional<UnitPoint> BilinearDistribution::invert(double u, double v) const {
    if (!(pdf_uv(u, v) > 0)) return std::nullopt;
    const Tables tables{rows_, columns_, row_begins_};
    const auto [s, t] = tables.place(v);
    const auto [i, r] = column_place(u, width());
    const Mixture mixture = tables.at(s, t).mixture;
    const auto quantum = [](double mass) { return unit_fixed((mass + 0x1p31) * (1 / k_total)); };
    return UnitPoint{quantum(mixture.edge(i, 0) + mixture.segment(i).before(r)),
                     quantum(rows_.edges_of(0)[s] + tables.marginal_segment(s).before(t))};
}

}  // namespace domelight
