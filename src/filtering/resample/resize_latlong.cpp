#include "filtering/resample/resize_latlong.h"

#include "domelight/base/vec.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace domelight {

namespace {

/// A source index and its share of a target texel; the shares of one texel sum to 1.
struct Share {
    int from;
    double weight;
};

/// Shares of `count` texels for each of `targets`, where `measure(x)` grows along the axis, x in [0, 1].
template <typename Measure>
std::vector<std::vector<Share>> shares(int count, int targets, Measure measure) {
    std::vector<std::vector<Share>> all(static_cast<std::size_t>(targets));
    for (int t = 0; t < targets; ++t) {
        const double begin = double(t) / targets, end = double(t + 1) / targets;
        const int last = std::min(count - 1, int(std::ceil(end * count)) - 1);
        for (int i = int(begin * count); i <= last; ++i) {
            const double a = std::max(begin, double(i) / count), b = std::min(end, double(i + 1) / count);
            if (b > a) all[std::size_t(t)].push_back({i, (measure(b) - measure(a)) / (measure(end) - measure(begin))});
        }
    }
    return all;
}

}  // namespace

ImageF resize_latlong(ImageView<const float> source, int width, int height) {
    const auto columns = shares(source.width, width, [](double u) { return u; });
    const auto rows = shares(source.height, height, [](double v) { return -std::cos(k_pi * v); });
    const int channels = source.channels;
    ImageF out(width, height, channels);
    std::vector<double> row(std::size_t(source.width) * channels);
    for (int y = 0; y < height; ++y) {
        std::fill(row.begin(), row.end(), 0.0);
        for (const Share& share : rows[std::size_t(y)])
            for (std::size_t i = 0; i < row.size(); ++i) row[i] += share.weight * double(source.row(share.from)[i]);
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) {
                double sum = 0;
                for (const Share& share : columns[std::size_t(x)])
                    sum += share.weight * row[std::size_t(share.from * channels + c)];
                out.at(x, y)[c] = float(sum);
            }
    }
    return out;
}

}  // namespace domelight
