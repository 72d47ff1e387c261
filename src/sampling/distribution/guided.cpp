#include "domelight/sampling/distribution/guided.h"

#include "sampling/distribution/guided_simd.h"
#include "sampling/distribution/quanta.h"
#include "sampling/distribution/weight_rows.h"

#include <bit>

namespace domelight {

namespace {

constexpr std::uint64_t k_quanta = std::uint64_t(1) << 32;

/// Position in [0, 1) of the middle of quantum xi in the item that owns it, of those it owns.
double position_in(std::uint32_t xi, std::uint32_t first, std::uint64_t quanta) {
    return (double(xi - first) + 0.5) / double(quanta);
}

/// The quantum at position t of an item.
std::uint32_t quantum_at(double t, std::uint32_t first, std::uint64_t quanta) {
    const double q = std::clamp(t * double(quanta), 0.0, double(quanta - 1));
    return first + std::uint32_t(q);
}

}  // namespace

GuidedRows::GuidedRows(int count_, int items_) : count(count_), items(items_) {
    shift = 32 - (int(std::bit_width(unsigned(items))) - 1);  // the largest power of two up to the number of items
    last.resize(std::size_t(count) * (items + 1) + 16);
    guide.resize(std::size_t(count) * (cells() + 8));
    std::fill_n(last.end() - 16, 16, 0xffffffffu);  // whole vectors are read
}

void GuidedRows::fill(int row, std::span<const float> weights, std::span<const double> sums) {
    std::uint32_t* l = last.data() + std::size_t(row) * (items + 1) + 1;
    std::uint16_t* g = guide.data() + std::size_t(row) * (cells() + 8);
    l[-1] = 0xffffffffu;  // so that item 0 begins after it, at 0
    const std::uint64_t cell = std::uint64_t(1) << shift;
    std::size_t filled = 0;  // cells that know their item
    share_quanta([&](int i) { return weights[i] > 0; }, sums, k_quanta,
                 [&](int i, std::uint64_t end) {
                     l[i] = std::uint32_t(end - 1);
                     // Cells that begin before `end` begin in item i. They are mostly few: eight are written without a
                     // test, and those too many are overwritten by later items.
                     const std::size_t cells_begun = (end + cell - 1) >> shift;
                     for (std::size_t k = 0; k < 8; ++k) g[filled + k] = std::uint16_t(i);
                     for (std::size_t k = filled + 8; k < cells_begun; ++k) g[k] = std::uint16_t(i);
                     filled = cells_begun;
                 });
}

void GuidedRows::fill_none(int row) {
    std::fill_n(last.data() + std::size_t(row) * (items + 1), items + 1, 0xffffffffu);
    std::fill_n(guide.data() + std::size_t(row) * (cells() + 8), cells(), std::uint16_t(0));
}

std::uint64_t GuidedRows::quanta_or_none(int row, int i) const {
    // All 2^32 and none look alike in the table; only the first owner can have all.
    const std::uint32_t* l = last_of(row);
    if (l[i] == l[i - 1] && i != guide_of(row)[0]) return 0;
    return quanta(row, i);
}

// ---- one dimension

Result<GuidedDistribution1D> GuidedDistribution1D::build(std::span<const float> weights) {
    GuidedDistribution1D d;
    const Weights one{int(weights.size()), 1, [&](int, std::span<float>) { return weights; }};
    bool empty = false;
    const auto add = [&](int, std::span<const float> row, std::span<const double> sums) {
        empty = sums.back() == 0;
        if (empty) return;
        d.rows_ = GuidedRows(1, int(row.size()));
        d.rows_.fill(0, row, sums);
    };
    if (auto read = for_each_weight_row(one, 1, add); !read) return read.error();
    if (empty) return build(std::vector<float>(weights.size(), 1.0f));
    return d;
}

GuidedDistribution1D::Sample GuidedDistribution1D::sample(std::uint32_t xi) const {
    const int i = rows_.find(0, xi);
    const std::uint64_t quanta = rows_.quanta(0, i);
    return {(i + position_in(xi, rows_.first_quantum(0, i), quanta)) * (1.0 / size()),
            double(quanta) * size() * 0x1p-32, i};
}

double GuidedDistribution1D::pdf(double x) const {
    return double(rows_.quanta_or_none(0, texel_index(x, size()))) * size() * 0x1p-32;
}

std::optional<std::uint32_t> GuidedDistribution1D::invert(double x) const {
    const int i = texel_index(x, size());
    const std::uint64_t quanta = rows_.quanta_or_none(0, i);
    if (quanta == 0) return std::nullopt;
    return quantum_at(x * size() - i, rows_.first_quantum(0, i), quanta);
}

// ---- two dimensions

Result<GuidedDistribution> GuidedDistribution::build(const Weights& weights, int threads) {
    GuidedDistribution d;
    std::vector<double> rows(std::max(0, weights.height));
    if (weights.width > 0 && weights.height > 0 && weights.width <= 65535 && weights.height <= 65535)
        d.conditional_ = GuidedRows(weights.height, weights.width);
    const auto add = [&](int y, std::span<const float> row, std::span<const double> sums) {
        rows[y] = sums.back();
        if (sums.back() > 0)
            d.conditional_.fill(y, row, sums);
        else
            d.conditional_.fill_none(y);
    };
    if (auto read = for_each_weight_row(weights, threads, add); !read) return read.error();

    // The weights of the rows only determine which rows can be drawn.
    std::vector<float> drawn(rows.size());
    for (std::size_t y = 0; y < rows.size(); ++y) drawn[y] = rows[y] > 0;
    for (std::size_t y = 1; y < rows.size(); ++y) rows[y] += rows[y - 1];
    if (rows.back() == 0) return build(uniform_weights(weights.width, weights.height), threads);
    d.marginal_ = GuidedRows(1, weights.height);
    d.marginal_.fill(0, drawn, rows);
    return d;
}

DistributionSample GuidedDistribution::sample(UnitPoint point) const {
    const int j = marginal_.find(0, point.y), i = conditional_.find(j, point.x);
    const std::uint64_t row = marginal_.quanta(0, j), column = conditional_.quanta(j, i);
    return {(i + position_in(point.x, conditional_.first_quantum(j, i), column)) * (1.0 / width()),
            (j + position_in(point.y, marginal_.first_quantum(0, j), row)) * (1.0 / height()),
            double(row) * double(column) * (double(width()) * height() * 0x1p-64)};
}

void GuidedDistribution::sample(std::span<const UnitPoint> points, std::span<float> u, std::span<float> v,
                                std::span<float> pdf_uv) const {
    assert(u.size() == points.size() && v.size() == points.size() && pdf_uv.size() == points.size());
    simd::sample_guided(marginal_, conditional_, points, u.data(), v.data(), pdf_uv.data());
}

double GuidedDistribution::pdf_uv(double u, double v) const {
    const int i = texel_index(u, width()), j = texel_index(v, height());
    const std::uint64_t row = marginal_.quanta_or_none(0, j);
    if (row == 0) return 0;
    return double(row) * double(conditional_.quanta_or_none(j, i)) * (double(width()) * height() * 0x1p-64);
}

std::optional<UnitPoint> GuidedDistribution::invert(double u, double v) const {
    if (pdf_uv(u, v) == 0) return std::nullopt;
    const int i = texel_index(u, width()), j = texel_index(v, height());
    return UnitPoint{quantum_at(u * width() - i, conditional_.first_quantum(j, i), conditional_.quanta(j, i)),
                     quantum_at(v * height() - j, marginal_.first_quantum(0, j), marginal_.quanta(0, j))};
}

}  // namespace domelight
