#include "filtering/harmonic/bright_split.h"

#include "domelight/base/frame.h"
#include "domelight/projection/projection.h"

#include "base/sort.h"
#include "filtering/harmonic/row_kernels.h"
#include "filtering/lights/tent_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace domelight {
namespace {

/// The distance from a light, in its widths, from which on four points may represent it.
constexpr double k_far = 12;

/// Replaces the points [from, to) by four points with the same power and first moments of each channel, and the same
/// second moments of the sum of the channels. At a distance s the error is of third order in the light's width over s.
///
/// With the principal axes e_k and deviations sigma_k the points lie at c +- sqrt(2) sigma_k e_k and have a quarter of
/// the power each; a shift m_k of a channel's centroid changes the quarters to 1/4 +- m_k / (2 sqrt(2) sigma_k).
void add_quartet(PointLights& points, const PointLights& of, int from, int to) {
    Vec3d sum, power;
    double total = 0;
    for (int i = from; i < to; ++i) {
        const double weight = double(of.r[i]) + of.g[i] + of.b[i];
        sum += of.place(i) * weight;
        power += Vec3d{of.r[i], of.g[i], of.b[i]};
        total += weight;
    }
    const Vec3d centre = sum / total, axis = normalize(centre);
    const Frame<double> frame(axis);
    double ss = 0, st = 0, tt = 0;
    std::array<Vec3d, 3> shift;  // of each channel's centroid, times its power
    for (int i = from; i < to; ++i) {
        const Vec3d d = of.place(i) - centre;
        const double weight = (double(of.r[i]) + of.g[i] + of.b[i]) / total, s = dot(d, frame.tangent),
                     t = dot(d, frame.bitangent);
        ss += weight * s * s, st += weight * s * t, tt += weight * t * t;
        shift[0] += d * of.r[i], shift[1] += d * of.g[i], shift[2] += d * of.b[i];
    }
    const double angle = 0.5 * std::atan2(2 * st, ss - tt), half = std::hypot(0.5 * (ss - tt), st);
    for (int k = 0; k < 2; ++k) {
        const double a = angle + k * k_pi / 2, sigma = std::sqrt(std::max(0.5 * (ss + tt) + (k ? -half : half), 0.0));
        const Vec3d e = frame.tangent * std::cos(a) + frame.bitangent * std::sin(a);
        for (int sign = -1; sign <= 1; sign += 2) {
            const auto part = [&](int c, double p) {
                return float(0.25 * p + (sigma > 0 ? sign * dot(shift[c], e) / (2 * std::numbers::sqrt2 * sigma) : 0));
            };
            const float rgb[3] = {part(0, power.x), part(1, power.y), part(2, power.z)};
            points.add(normalize(axis + e * (sign * std::numbers::sqrt2 * sigma)), 1, rgb);
        }
    }
}

}  // namespace

void BrightSplit::take_from(ImageView<float> rows, std::span<const simd::Summary> summaries) {
    for (int y = 0; y < rows.height; ++y, ++next_row_) {
        const double solid_angle = latlong_solid_angle(next_row_, width_, height_);
        float* row = rows.row(y);
        const simd::Summary& summary = summaries[std::size_t(y)];
        // The darker half of the row itself counts too, so that an ordinary sky is not removed from the first rows.
        double row_sum = summary.sum / 3;
        const double mean = (sum_ + row_sum * solid_angle) / (weight_ + width_ * solid_angle);
        const double before = weight_ > 0 ? sum_ / weight_ : mean;
        const double least = k_outshine * std::max(std::min(mean, before), 1e-30);
        for (int x = 0; summary.largest > least && x < width_ && int(texels_.size()) < k_most; ++x) {
            float* p = row + 3 * x;
            if (std::max({p[0], p[1], p[2]}) <= least) continue;
            row_sum -= (double(p[0]) + p[1] + p[2]) / 3;
            texels_.push_back({x, next_row_, {p[0], p[1], p[2]}});
            p[0] = p[1] = p[2] = 0;
        }
        sum_ += std::max(row_sum, 0.0) * solid_angle;
        weight_ += width_ * solid_angle;
    }
}

/// Builds the tree over texels, all of one kernel.
class BrightSplit::TreeBuilder {
  public:
    TreeBuilder(const BrightSplit& split, double lobe_width) : split_(split), lobe_width_(lobe_width) {
        const double texel_angle = k_pi / split.height_;
        const int nodes = std::clamp(2 + int(std::ceil(4 * texel_angle / lobe_width)), 3, 16);
        for (const LoneTexel& t : split.texels_) {
            first_.push_back(fine_.count());
            add_tent_nodes(fine_, split.width_, split.height_, t.x, t.y, t.rgb, nodes);
        }
        first_.push_back(fine_.count());
    }

    Lights build() && {
        std::vector<int> order(split_.texels_.size());
        std::iota(order.begin(), order.end(), 0);
        if (!order.empty()) add(order);
        return std::move(lights_);
    }

  private:
    void add(std::span<int> texels) {
        PointLights below;
        for (const int t : texels) below.append(fine_, first_[t], first_[t + 1]);
        const std::size_t here = lights_.nodes.size();
        simd::LightNode node{};
        node.first = lights_.points.count();
        add_quartet(lights_.points, below, 0, below.count());
        node.count = lights_.points.count() - node.first;
        Vec3d centre;
        for (int i = node.first; i < node.first + node.count; ++i) centre += lights_.points.place(i);
        centre = normalize(centre);
        node.x = float(centre.x), node.y = float(centre.y), node.z = float(centre.z);
        double radius = 0;
        for (int i = 0; i < below.count(); ++i) radius = std::max(radius, length(below.place(i) - centre));
        // For K ~ (s^2 + b^2)^-2 the four points are wrong by terms of about 20 (radius / 2 s)^3, of alternating sign.
        // The widest lobes are cosines, which are no smoother than b ~ 1.
        const double b = std::min(lobe_width_, 0.7);
        const double far = std::sqrt(std::max(std::pow(k_far * radius, 2) - b * b, 0.0));
        node.cos_far = float(std::cos(std::min(far + radius, k_pi)));
        node.radius = float(radius);
        lights_.nodes.push_back(node);
        if (texels.size() > 1) {
            add_halves(texels);
        } else {
            node.first = lights_.points.count();
            node.count = below.count();
            node.cos_far = 2;
            node.skip = int(lights_.nodes.size()) + 1;
            lights_.points.append(below, 0, below.count());
            lights_.nodes.push_back(node);
        }
        lights_.nodes[here].skip = int(lights_.nodes.size());
    }

    /// Split along the axis of the image along which the texels spread most.
    void add_halves(std::span<int> texels) {
        const auto& all = split_.texels_;
        const auto [x0, x1] =
            std::minmax_element(texels.begin(), texels.end(), [&](int a, int b) { return all[a].x < all[b].x; });
        const auto [y0, y1] =
            std::minmax_element(texels.begin(), texels.end(), [&](int a, int b) { return all[a].y < all[b].y; });
        const bool by_x = all[*x1].x - all[*x0].x > all[*y1].y - all[*y0].y;
        const auto half = texels.begin() + texels.size() / 2;
        sort_items(texels, [&](int a, int b) {
            const auto key = [&](int t) {
                return by_x ? std::pair(all[t].x, all[t].y) : std::pair(all[t].y, all[t].x);
            };
            return key(a) < key(b);
        });
        add({texels.begin(), half});
        add({half, texels.end()});
    }

    const BrightSplit& split_;
    double lobe_width_;
    PointLights fine_;
    std::vector<int> first_;  ///< of each texel's points in fine_
    Lights lights_;
};

BrightSplit::Lights BrightSplit::lights(const ZonalKernel& kernel) const {
    return TreeBuilder(*this, kernel.angular_width()).build();
}

DirectKernelTable::DirectKernelTable(const ZonalKernel& kernel) {
    if (kernel.lobe == Lobe::ggx) {
        // From the density along the axis, 1 / (2 alpha^2)^2 times the scale.
        alpha2 = float(kernel.width * kernel.width);
        scale = float(kernel.density(0) * 4 * kernel.width * kernel.width * kernel.width * kernel.width);
        return;
    }
    constexpr int steps = 16384;
    values.resize(steps + 2);
    for (int i = 0; i <= steps; ++i) values[i] = float(kernel.density(k_pi * i / steps));
    values[steps + 1] = values[steps];
}

}  // namespace domelight
