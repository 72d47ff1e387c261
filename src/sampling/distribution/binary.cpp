#include "domelight/sampling/distribution/binary.h"

#include "sampling/distribution/texel_float.h"
#include "sampling/distribution/weight_rows.h"

#include <algorithm>

namespace domelight {

namespace {

/// The i with cdf[i] <= u < cdf[i + 1], 0 <= i < n. By bisection with a branch: the processor predicts the branch and
/// fetches ahead, which is twice as fast as waiting for each fetch.
int find_interval(const float* cdf, int n, float u) {
    int first = 1, size = n;
    while (size > 0) {
        const int half = size >> 1, middle = first + half;
        if (cdf[middle] <= u) {
            first = middle + 1;
            size -= half + 1;
        } else {
            size = half;
        }
    }
    // A table may end in 1 several times over; u < 1, so the first of these is the end.
    return std::min(first - 1, n - 1);
}

/// Keeps a position inside its texel if rounding has moved it to the border.
double inside(float t) {
    return std::clamp(double(t), 0x1p-26, 1 - 0x1p-26);
}

/// Cumulative sums over their total, which is 1 exactly.
void fill_cumulative(std::span<const double> sums, float* cdf) {
    const double scale = 1 / sums.back();
    cdf[0] = 0;
    for (std::size_t i = 0; i < sums.size(); ++i)
        cdf[i + 1] = sums[i] == sums.back() ? 1.0f : std::min(1.0f, float(sums[i] * scale));
}

}  // namespace

Result<BinaryDistribution> BinaryDistribution::build(const Weights& weights, int threads) {
    BinaryDistribution d;
    d.width_ = weights.width, d.height_ = weights.height;
    if (weights.width > 0 && weights.height > 0) d.columns_.resize(std::size_t(weights.width + 1) * weights.height);
    std::vector<double> rows(std::max(0, weights.height));
    const auto add = [&](int y, std::span<const float>, std::span<const double> sums) {
        rows[y] = sums.back();
        float* cdf = d.columns_.data() + std::size_t(y) * (d.width_ + 1);
        if (sums.back() > 0)
            fill_cumulative(sums, cdf);
        else
            std::fill_n(cdf, d.width_ + 1, 0.0f);
    };
    if (auto read = for_each_weight_row(weights, threads, add); !read) return read.error();
    for (int y = 1; y < d.height_; ++y) rows[y] += rows[y - 1];
    if (rows.back() == 0) return build(uniform_weights(d.width_, d.height_), threads);
    d.rows_.resize(d.height_ + 1);
    fill_cumulative(rows, d.rows_.data());
    return d;
}

struct BinaryDistribution::Place {
    int column, row;
    float t, s;  // position in the texel
    float pdf_uv;
};

inline BinaryDistribution::Place BinaryDistribution::find(UnitPoint point) const {
    const float x = unit_float(point.x), y = unit_float(point.y);
    const int j = find_interval(rows_.data(), height_, y);
    const float row = rows_[j + 1] - rows_[j];
    const float* cdf = columns_.data() + std::size_t(j) * (width_ + 1);
    const int i = find_interval(cdf, width_, x);
    const float column = cdf[i + 1] - cdf[i];
    return {i, j, (x - cdf[i]) / column, (y - rows_[j]) / row, row * column * (float(width_) * float(height_))};
}

DistributionSample BinaryDistribution::sample(UnitPoint point) const {
    const Place p = find(point);
    return {(p.column + inside(p.t)) * (1.0 / width_), (p.row + inside(p.s)) * (1.0 / height_), p.pdf_uv};
}

void BinaryDistribution::sample(std::span<const UnitPoint> points, std::span<float> u, std::span<float> v,
                                std::span<float> pdf_uv) const {
    const double to_u = 1.0 / width_, to_v = 1.0 / height_;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Place p = find(points[i]);
        u[i] = texel_float((p.column + inside(p.t)) * to_u, p.column, width_);
        v[i] = texel_float((p.row + inside(p.s)) * to_v, p.row, height_);
        pdf_uv[i] = p.pdf_uv;
    }
}

double BinaryDistribution::pdf_uv(double u, double v) const {
    const int i = texel_index(u, width_), j = texel_index(v, height_);
    const float* cdf = columns_.data() + std::size_t(j) * (width_ + 1);
    return (rows_[j + 1] - rows_[j]) * (cdf[i + 1] - cdf[i]) * (float(width_) * float(height_));
}

std::optional<UnitPoint> BinaryDistribution::invert(double u, double v) const {
    if (pdf_uv(u, v) == 0) return std::nullopt;
    const int i = texel_index(u, width_), j = texel_index(v, height_);
    const float* cdf = columns_.data() + std::size_t(j) * (width_ + 1);
    const auto back = [](const float* c, double t) { return unit_fixed(c[0] + (double(c[1]) - c[0]) * t); };
    return UnitPoint{back(cdf + i, u * width_ - i), back(rows_.data() + j, v * height_ - j)};
}

}  // namespace domelight
