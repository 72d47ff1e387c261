#include "domelight/sampling/distribution/plain.h"

#include "sampling/distribution/weight_rows.h"

#include <algorithm>

namespace domelight {

PlainDistribution1D::PlainDistribution1D(std::span<const double> values)
    : values_(values.begin(), values.end()), cumulative_(values.size() + 1), sum_(0) {
    for (double f : values) sum_ += f;
    if (sum_ == 0) std::fill(values_.begin(), values_.end(), 1.0);
    for (std::size_t i = 0; i < values_.size(); ++i) cumulative_[i + 1] = cumulative_[i] + values_[i];
}

PlainDistribution1D::Sample PlainDistribution1D::sample_linear(double xi) const {
    const int n = size();
    const double total = cumulative_[n], target = xi * total;
    int i = 0;
    while (i < n - 1 && cumulative_[i + 1] <= target) ++i;
    const double t = (target - cumulative_[i]) / values_[i];
    return {(i + std::clamp(t, 0.0, 1 - 0x1p-40)) / n, values_[i] * n / total, i};
}

PlainDistribution1D::Sample PlainDistribution1D::sample_walk(double xi) const {
    const int n = size();
    double rest = xi * cumulative_[n];
    int i = 0;
    while (i < n - 1 && rest >= values_[i]) rest -= values_[i++];
    while (values_[i] == 0) --i;  // because of rounding, the remainder may lead past the last value that is not zero
    return {(i + std::clamp(rest / values_[i], 0.0, 1 - 0x1p-40)) / n, values_[i] * n / cumulative_[n], i};
}

double PlainDistribution1D::pdf(double x) const {
    return values_[texel_index(x, size())] * size() / cumulative_[size()];
}

double PlainDistribution1D::invert(double x) const {
    const int i = texel_index(x, size());
    return (cumulative_[i] + values_[i] * (x * size() - i)) / cumulative_[size()];
}

Result<PlainDistribution2D> PlainDistribution2D::build(const Weights& weights, Search search) {
    std::vector<PlainDistribution1D> rows;
    std::vector<double> averages;
    const auto add = [&](int, std::span<const float> row, std::span<const double>) {
        rows.emplace_back(std::vector<double>(row.begin(), row.end()));
        averages.push_back(rows.back().mean());
    };
    if (auto read = for_each_weight_row(weights, 1, add); !read) return read.error();
    return PlainDistribution2D(std::move(rows), PlainDistribution1D(averages), search);
}

DistributionSample PlainDistribution2D::sample(UnitPoint point) const {
    // The middle of the point's quantum, as everywhere.
    const double x = (point.x + 0.5) * 0x1p-32, y = (point.y + 0.5) * 0x1p-32;
    if (search_ == Search::walk) {
        const auto row = averages_.sample_walk(y);
        const auto column = rows_[row.index].sample_walk(x);
        return {column.x, row.x, row.pdf * column.pdf};
    }
    const auto row = averages_.sample_linear(y);
    const auto column = rows_[row.index].sample_linear(x);
    return {column.x, row.x, row.pdf * column.pdf};
}

double PlainDistribution2D::pdf_uv(double u, double v) const {
    return averages_.pdf(v) * rows_[texel_index(v, height())].pdf(u);
}

std::optional<UnitPoint> PlainDistribution2D::invert(double u, double v) const {
    if (pdf_uv(u, v) == 0) return std::nullopt;
    return UnitPoint{unit_fixed(rows_[texel_index(v, height())].invert(u)), unit_fixed(averages_.invert(v))};
}

std::size_t PlainDistribution2D::memory_bytes() const {
    std::size_t bytes = averages_.memory_bytes();
    for (const auto& row : rows_) bytes += row.memory_bytes();
    return bytes;
}

}  // namespace domelight
