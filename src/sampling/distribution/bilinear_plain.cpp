#include "domelight/sampling/distribution/bilinear.h"

#include "sampling/distribution/bilinear_place.h"
#include "sampling/distribution/weight_rows.h"

#include <algorithm>

namespace domelight {

Result<PlainBilinearDistribution> PlainBilinearDistribution::build(const Weights& weights) {
    PlainBilinearDistribution d;
    d.width_ = weights.width, d.height_ = weights.height;
    const auto add = [&](int, std::span<const float> row, std::span<const double> sums) {
        d.weights_.insert(d.weights_.end(), row.begin(), row.end());
        d.row_sums_.push_back(sums.back());
        d.total_ += sums.back();
    };
    if (auto read = for_each_weight_row(weights, 1, add); !read) return read.error();
    if (d.total_ == 0) return build(uniform_weights(d.width_, d.height_));
    return d;
}

double PlainBilinearDistribution::node(int i, int s, double t) const {
    const RowSegment place = row_segment(s, height_);
    i %= width_;
    return weights_[std::size_t(place.above) * width_ + i] * (1 - t) +
           weights_[std::size_t(place.below) * width_ + i] * t;
}

DistributionSample PlainBilinearDistribution::sample(UnitPoint point) const {
    // Row segments: the interpolated row sums over v, in rows; together they integrate to total_.
    double rest = (point.y + 0.5) * 0x1p-32 * total_;
    int s = 0;
    const auto marginal = [&](int k) {
        const RowSegment place = row_segment(k, height_);
        return LinearSegment{row_sums_[place.above] * place.length, row_sums_[place.below] * place.length};
    };
    while (s < height_ && rest >= marginal(s).before(1)) rest -= marginal(s++).before(1);
    const double t = marginal(s).invert(rest);
    const RowSegment place = row_segment(s, height_);

    // Column segments at this v: from the centre of each texel to the next one's.
    const auto column = [&](int k) { return LinearSegment{node(k, s, t), node(k + 1, s, t)}; };
    double sum = 0;
    for (int k = 0; k < width_; ++k) sum += column(k).before(1);
    rest = (point.x + 0.5) * 0x1p-32 * sum;
    int i = 0;
    while (i < width_ - 1 && rest >= column(i).before(1)) rest -= column(i++).before(1);
    const double r = column(i).invert(rest);
    double u = (i + 0.5 + r) / width_;
    if (u >= 1) u -= 1;
    return {u, std::min((place.start + t * place.length) / height_, 1 - 0x1p-53),
            column(i).at(r) * width_ * height_ / total_};
}

double PlainBilinearDistribution::pdf_uv(double u, double v) const {
    const int s = row_segment_at(v, height_);
    const RowSegment place = row_segment(s, height_);
    const double t = (v * height_ - place.start) / place.length;
    double x = u * width_ - 0.5;
    if (x < 0) x += width_;
    const int i = std::min(int(x), width_ - 1);
    return LinearSegment{node(i, s, t), node(i + 1, s, t)}.at(x - i) * width_ * height_ / total_;
}

std::optional<UnitPoint> PlainBilinearDistribution::invert(double u, double v) const {
    if (!(pdf_uv(u, v) > 0)) return std::nullopt;
    const int s = row_segment_at(v, height_);
    const RowSegment place = row_segment(s, height_);
    const double t = (v * height_ - place.start) / place.length;
    double before = 0;
    const auto marginal = [&](int k) {
        const RowSegment segment = row_segment(k, height_);
        return LinearSegment{row_sums_[segment.above] * segment.length, row_sums_[segment.below] * segment.length};
    };
    for (int k = 0; k < s; ++k) before += marginal(k).before(1);
    const double y = (before + marginal(s).before(t)) / total_;

    double x = u * width_ - 0.5, sum = 0;
    if (x < 0) x += width_;
    const int i = std::min(int(x), width_ - 1);
    before = 0;
    for (int k = 0; k < width_; ++k) {
        const LinearSegment segment{node(k, s, t), node(k + 1, s, t)};
        if (k == i) before = sum + segment.before(x - i);
        sum += segment.before(1);
    }
    return UnitPoint{unit_fixed(before / sum), unit_fixed(y)};
}

}  // namespace domelight
