#include "filtering/harmonic/bright_texels.h"

#include "domelight/projection/projection.h"

#include "base/sort.h"
#include "filtering/harmonic/row_kernels.h"
#include "filtering/lights/tent_nodes.h"

#include <algorithm>
#include <cmath>

namespace domelight {

namespace {

/// A texel smaller than this part of 1 / L is a point to degrees around L: its tent's second moment, (tau L)^2 / 12, is
/// below 3 %, of what is a thousandth itself.
constexpr double k_point_like = 0.6;
/// A texel with more than this part of the total power has twice the nodes.
constexpr double k_refined_share = 2e-3;

}  // namespace

BrightTexels::BrightTexels(int width, int height, int most) : width_(width), height_(height), most_(most) {
    heap_.reserve(most + 1);
}

void BrightTexels::add_rows(ImageView<const float> rows, std::span<const simd::Summary> summaries) {
    for (int y = 0; y < rows.height; ++y, ++next_row_) {
        const float* row = rows.row(y);
        const double solid_angle = latlong_solid_angle(next_row_, width_, height_);
        const simd::Summary& summary = summaries[std::size_t(y)];
        sum_ += summary.sum / 3 * solid_angle;
        // A texel too weak compared with the rows so far is too weak compared with all rows. (The threshold is halved,
        // because points() is given the mean of the reconstruction.)
        const double too_weak = 0.5 * k_least_share * sum_;
        const auto weakest = [&] {
            return int(heap_.size()) < most_ ? too_weak : std::max(too_weak, heap_.front().power);
        };
        if (summary.largest * solid_angle <= weakest()) continue;
        for (int x = 0; x < width_; ++x) {
            const float* p = row + 3 * x;
            const double power = std::max({p[0], p[1], p[2]}) * solid_angle;
            if (power <= weakest()) continue;
            heap_.push_back({power, x, next_row_, {p[0], p[1], p[2]}});
            std::push_heap(heap_.begin(), heap_.end(), stronger);
            if (int(heap_.size()) > most_) {
                std::pop_heap(heap_.begin(), heap_.end(), stronger);
                heap_.pop_back();
            }
        }
    }
}

PointLights BrightTexels::points(const Vec3d& mean, int band_limit) const {
    const double largest = std::max({mean.x, mean.y, mean.z}), total = 4 * k_pi * largest;
    std::vector<Texel> texels;
    for (const Texel& t : heap_)
        if (t.power > k_least_share * total && std::max({t.rgb[0], t.rgb[1], t.rgb[2]}) > k_least_contrast * largest)
            texels.push_back(t);
    sort_items(texels, [](const Texel& a, const Texel& b) { return stronger(a, b); });

    // A texel wider than a few waves is not a point: its own tent is so smooth that the truncation has no effect.
    const int nodes = 1 + int(k_pi / height_ * band_limit);
    if (nodes > 16) return {};
    if (k_pi / height_ * band_limit < k_point_like) {
        PointLights points;
        for (const Texel& t : texels) {
            const double theta = k_pi * (t.y + 0.5) / height_, s = std::sin(theta),
                         phi = 2 * k_pi * (t.x + 0.5) / width_ - k_pi;
            points.add({s * std::cos(phi), std::cos(theta), s * std::sin(phi)},
                       latlong_solid_angle(t.y, width_, height_), t.rgb);
        }
        return points;
    }
    // The kink of the kernel needs more nodes than the waves do, where a texel is a considerable part of all.
    TentPatches patches(width_, height_, nodes);
    for (const Texel& t : texels)
        if (t.power > k_refined_share * total) patches.refine(t.x, t.y);
    for (const Texel& t : texels) {
        if (patches.lights().count() >= k_most_patches * nodes * nodes) break;
        patches.add(t.x, t.y, t.rgb);
    }
    return patches.lights();
}

}  // namespace domelight
