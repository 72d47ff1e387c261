#include "domelight/sampling/distribution/hierarchical.h"

#include "sampling/distribution/weight_rows.h"

#include <algorithm>
#include <cmath>

namespace domelight {

Result<HierarchicalDistribution> HierarchicalDistribution::build(const Weights& weights, int threads) {
    HierarchicalDistribution d;
    const int w = std::max(0, weights.width), h = std::max(0, weights.height);
    double largest = 0;
    std::vector<double> row_largest(h);
    d.levels_.push_back({w, h, {}});
    if (w > 0 && h > 0 && w <= 65535 && h <= 65535) d.levels_[0].sums.resize(std::size_t(w) * h);
    const auto add = [&](int y, std::span<const float> row, std::span<const double>) {
        std::copy(row.begin(), row.end(), d.levels_[0].sums.begin() + std::size_t(y) * w);
        row_largest[y] = *std::max_element(row.begin(), row.end());
    };
    if (auto read = for_each_weight_row(weights, threads, add); !read) return read.error();
    for (double m : row_largest) largest = std::max(largest, m);
    if (largest == 0) return build(uniform_weights(w, h), threads);
    // Sums are floats, so they are scaled away from both ends of the range. A power of two changes no ratio.
    const float scale = std::ldexp(1.0f, -std::clamp(std::ilogb(largest), -126, 126));
    for (float& x : d.levels_[0].sums) x *= scale;

    while (d.levels_.back().width > 1 || d.levels_.back().height > 1) {
        const Level& from = d.levels_.back();
        Level to{(from.width + 1) / 2, (from.height + 1) / 2, {}};
        to.sums.resize(std::size_t(to.width) * to.height);
        for (int j = 0; j < to.height; ++j)
            for (int i = 0; i < to.width; ++i)
                to.sums[std::size_t(j) * to.width + i] =
                    float(from.at(2 * i, 2 * j) + from.at(2 * i + 1, 2 * j) + from.at(2 * i, 2 * j + 1) +
                          from.at(2 * i + 1, 2 * j + 1));
        d.levels_.push_back(std::move(to));
    }
    return d;
}

/// How a cell is split into the 2 x 2 cells under it.
struct HierarchicalDistribution::Split {
    double left;    ///< share of the left column
    double top[2];  ///< share of the upper cell in each column
    double share(int i, int j) const { return (i ? 1 - left : left) * (j ? 1 - top[i] : top[i]); }
};

HierarchicalDistribution::Split HierarchicalDistribution::split(int level, int i, int j) const {
    const Level& below = levels_[level];
    const double a = below.at(2 * i, 2 * j), b = below.at(2 * i + 1, 2 * j), c = below.at(2 * i, 2 * j + 1),
                 e = below.at(2 * i + 1, 2 * j + 1);
    const auto share = [](double one, double other) { return one > 0 ? one / (one + other) : 0.0; };
    return {share(a + c, b + e), {share(a, c), share(b, e)}};
}

namespace {

/// The half that x in (0, 1) falls into, and the position of x in it; a half with share 0 is never chosen.
int descend(double& x, double first) {
    const int second = x >= first;
    x = second ? (x - first) / (1 - first) : x / first;
    x = std::clamp(x, 0x1p-53, 1 - 0x1p-40);
    return second;
}

}  // namespace

DistributionSample HierarchicalDistribution::sample(UnitPoint point) const {
    double x = (point.x + 0.5) * 0x1p-32, y = (point.y + 0.5) * 0x1p-32, probability = 1;
    int i = 0, j = 0;
    for (int level = int(levels_.size()) - 2; level >= 0; --level) {
        const Split s = split(level, i, j);
        const int right = descend(x, s.left), lower = descend(y, s.top[right]);
        probability *= s.share(right, lower);
        i = 2 * i + right;
        j = 2 * j + lower;
    }
    return {(i + x) / width(), (j + y) / height(), probability * width() * height()};
}

double HierarchicalDistribution::pdf_uv(double u, double v) const {
    const int i = texel_index(u, width()), j = texel_index(v, height());
    double probability = 1;
    for (int level = int(levels_.size()) - 2; level >= 0; --level)
        probability *= split(level, i >> (level + 1), j >> (level + 1)).share((i >> level) & 1, (j >> level) & 1);
    return probability * width() * height();
}

std::optional<UnitPoint> HierarchicalDistribution::invert(double u, double v) const {
    if (pdf_uv(u, v) == 0) return std::nullopt;
    const int i = texel_index(u, width()), j = texel_index(v, height());
    double x = u * width() - i, y = v * height() - j;
    for (int level = 0; level + 1 < int(levels_.size()); ++level) {
        const Split s = split(level, i >> (level + 1), j >> (level + 1));
        const int right = (i >> level) & 1, lower = (j >> level) & 1;
        x = right ? s.left + x * (1 - s.left) : x * s.left;
        y = lower ? s.top[right] + y * (1 - s.top[right]) : y * s.top[right];
    }
    return UnitPoint{unit_fixed(x), unit_fixed(y)};
}

std::size_t HierarchicalDistribution::memory_bytes() const {
    std::size_t bytes = 0;
    for (const Level& level : levels_) bytes += level.sums.size() * sizeof(float);
    return bytes;
}

}  // namespace domelight
