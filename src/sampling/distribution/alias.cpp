#include "domelight/sampling/distribution/alias.h"

#include "sampling/distribution/alias_simd.h"
#include "sampling/distribution/quanta.h"
#include "sampling/distribution/weight_rows.h"

#include <bit>
#include <cassert>

namespace domelight {

AliasRows::AliasRows(int count_, int items_)
    : count(count_), items(items_), bits(std::bit_width(unsigned(items_ - 1))) {
    // One bit at least: a shift by 32 is not defined.
    bits = std::max(bits, 1);
    entries.resize(std::size_t(count) << bits);
}

void AliasRows::fill(int row, std::span<const float> weights, std::span<const double> sums) {
    Entry* e = entries.data() + (std::size_t(row) << bits);
    const int cells = 1 << bits, split_bits = 32 - bits;
    const std::uint64_t room = std::uint64_t(1) << split_bits;  // quanta of a cell

    // Vose's method in integers: cells whose item has less than a full cell ("small") are filled up from items with
    // more ("large").
    std::vector<std::uint64_t> left(cells);  // quanta not yet placed
    std::vector<std::int32_t> stack(cells);  // small from the front, large from the back
    int small = 0, large = cells;
    std::uint64_t before = 0;
    share_quanta([&](int i) { return weights[i] > 0; }, sums, std::uint64_t(1) << 32,
                 [&](int i, std::uint64_t end) {
                     left[i] = end - before;
                     before = end;
                 });
    for (int i = 0; i < cells; ++i) {
        e[i].last_quantum = std::uint32_t(left[i] - 1);
        if (left[i] < room)
            stack[small++] = i;
        else
            stack[--large] = i;
    }
    while (small > 0) {
        // All cells together have space for exactly all quanta, so while one has space left, some item has quanta left.
        assert(large < cells);
        const int i = stack[--small], from = stack[large];
        e[i].alias_and_split = std::uint32_t(from) << split_bits | std::uint32_t(left[i]);
        left[from] -= room - left[i];
        if (left[from] < room) {
            stack[small++] = from;
            ++large;
        }
    }
    // An item that remains fills its own cell: split 0 and itself as alias.
    for (; large < cells; ++large) e[stack[large]].alias_and_split = std::uint32_t(stack[large]) << split_bits;
}

AliasRows::Draw AliasRows::draw(int row_index, std::uint32_t xi) const {
    const Entry* e = row(row_index);
    const int split_bits = 32 - bits;
    const std::uint32_t mask = (1u << split_bits) - 1, place = xi & mask, cell = xi >> split_bits;
    const std::uint32_t packed = e[cell].alias_and_split, split = packed & mask;
    const bool own = place < split;
    const std::uint32_t item = own ? cell : packed >> split_bits;
    const std::uint32_t begin = own ? 0 : split, end = own ? split : mask + 1;
    return {int(item), (double(place - begin) + 0.5) / double(end - begin), double(e[item].last_quantum) + 1};
}

double AliasRows::quanta_or_none(int row_index, int item) const {
    // None and all 2^32 quanta look alike; an item with all fills its own cell.
    const Entry& e = row(row_index)[item];
    if (e.last_quantum == 0xffffffffu && e.alias_and_split != std::uint32_t(item) << (32 - bits)) return 0;
    return double(e.last_quantum) + 1;
}

Result<AliasDistribution> AliasDistribution::build(const Weights& weights, int threads) {
    AliasDistribution d;
    std::vector<double> rows(std::max(0, weights.height));
    if (weights.width > 0 && weights.height > 0 && weights.width <= 65535 && weights.height <= 65535)
        d.conditional_ = AliasRows(weights.height, weights.width);
    const auto add = [&](int y, std::span<const float> row, std::span<const double> sums) {
        rows[y] = sums.back();
        // A row without light is never drawn from; its density is zero by the marginal.
        if (sums.back() > 0) d.conditional_.fill(y, row, sums);
    };
    if (auto read = for_each_weight_row(weights, threads, add); !read) return read.error();

    std::vector<float> drawn(rows.size());
    for (std::size_t y = 0; y < rows.size(); ++y) drawn[y] = rows[y] > 0;
    for (std::size_t y = 1; y < rows.size(); ++y) rows[y] += rows[y - 1];
    if (rows.back() == 0) return build(uniform_weights(weights.width, weights.height), threads);
    d.marginal_ = AliasRows(1, weights.height);
    d.marginal_.fill(0, drawn, rows);
    return d;
}

DistributionSample AliasDistribution::sample(UnitPoint point) const {
    const AliasRows::Draw row = marginal_.draw(0, point.y), column = conditional_.draw(row.item, point.x);
    return {(column.item + column.t) * (1.0 / width()), (row.item + row.t) * (1.0 / height()),
            row.quanta * column.quanta * (double(width()) * height() * 0x1p-64)};
}

void AliasDistribution::sample(std::span<const UnitPoint> points, std::span<float> u, std::span<float> v,
                               std::span<float> pdf_uv) const {
    assert(u.size() == points.size() && v.size() == points.size() && pdf_uv.size() == points.size());
    simd::sample_alias(marginal_, conditional_, points, u.data(), v.data(), pdf_uv.data());
}

double AliasDistribution::pdf_uv(double u, double v) const {
    const int j = texel_index(v, height());
    const double row = marginal_.quanta_or_none(0, j);
    if (row == 0) return 0;
    return row * conditional_.quanta_or_none(j, texel_index(u, width())) * (double(width()) * height() * 0x1p-64);
}

}  // namespace domelight
