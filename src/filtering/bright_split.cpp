#include "filtering/bright_split.h"

#include <algorithm>
#include <cmath>

#include "domelight/projection.h"
#include "domelight/spherical_harmonics.h"
#include "filtering/tent_nodes.h"

namespace domelight {
namespace {

/// Texels a cluster is wide and high.
constexpr int k_cluster = 4;

/// Power and centroid of points [from, to) as one point.
void add_centroid(BrightPoints& points, const BrightPoints& of, int from, int to) {
    Vec3d centre, power;
    for (int i = from; i < to; ++i) {
        const double weight = double(of.r[i]) + of.g[i] + of.b[i];
        centre = centre + Vec3d{of.x[i], of.y[i], of.z[i]} * weight;
        power = power + Vec3d{of.r[i], of.g[i], of.b[i]};
    }
    const float rgb[3] = {float(power.x), float(power.y), float(power.z)};
    points.add(normalize(centre), 1, rgb);
}

}  // namespace

void BrightSplit::take_from(ImageView<float> rows) {
    for (int y = 0; y < rows.height; ++y, ++next_row_) {
        const double solid_angle = latlong_solid_angle(next_row_, width_, height_);
        float* row = rows.row(y);
        // The row's own dark half counts too, so that the first rows do not throw out an ordinary sky.
        double row_sum = 0;
        for (int x = 0; x < width_; ++x) row_sum += std::max({row[3 * x], row[3 * x + 1], row[3 * x + 2]});
        const double mean = (sum_ + row_sum * solid_angle) / (weight_ + width_ * solid_angle);
        const double before = weight_ > 0 ? sum_ / weight_ : mean;
        const double least = k_outshine * std::max(std::min(mean, before), 1e-30);
        for (int x = 0; x < width_; ++x) {
            float* p = row + 3 * x;
            const float largest = std::max({p[0], p[1], p[2]});
            if (largest > least && int(texels_.size()) < k_most) {
                texels_.push_back({x, next_row_, {p[0], p[1], p[2]}});
                p[0] = p[1] = p[2] = 0;
            } else {
                sum_ += largest * solid_angle;
            }
        }
        weight_ += width_ * solid_angle;
    }
}

BrightPoints BrightSplit::points(int nodes) const {
    BrightPoints points;
    for (const Texel& t : texels_) add_tent_nodes(points, width_, height_, t.x, t.y, t.rgb, nodes);
    return points;
}

Vec3d BrightSplit::power() const {
    const BrightPoints p = points(2);
    Vec3d sum;
    for (int i = 0; i < p.count(); ++i) sum = sum + Vec3d{p.r[i], p.g[i], p.b[i]};
    return sum;
}

void BrightSplit::add_to_sh(std::vector<Vec3d>& coefficients, int bands, const Mat3& world_to_source) const {
    const BrightPoints p = points(2);
    const Mat3 source_to_world = world_to_source.transposed();
    std::vector<double> basis(coefficients.size());
    for (int i = 0; i < p.count(); ++i) {
        sh_basis(normalize(source_to_world * Vec3d{p.x[i], p.y[i], p.z[i]}), bands, basis);
        for (std::size_t k = 0; k < basis.size(); ++k) coefficients[k] = coefficients[k] + Vec3d{p.r[i], p.g[i], p.b[i]} * basis[k];
    }
}

BrightSplit::Lights BrightSplit::lights(const ZonalKernel& kernel) const {
    const double texel_angle = k_pi / height_, b = kernel.angular_width();
    const int nodes = std::clamp(2 + int(std::ceil(4 * texel_angle / b)), 3, 16);
    // Clusters by tile of the image, in order of rows and columns.
    std::map<std::pair<int, int>, std::vector<const Texel*>> tiles;
    for (const Texel& t : texels_) tiles[{t.y / k_cluster, t.x / k_cluster}].push_back(&t);

    BrightPoints coarse, middle, fine;
    Lights lights;
    for (const auto& [tile, texels] : tiles) {
        const int first_middle = middle.count();
        simd::LightCluster cluster{0, 0, 0, 0, 0, 0, coarse.count(), first_middle, fine.count()};
        for (const Texel* t : texels) {
            const int first = fine.count();
            add_tent_nodes(fine, width_, height_, t->x, t->y, t->rgb, nodes);
            add_centroid(middle, fine, first, fine.count());
        }
        add_centroid(coarse, middle, first_middle, middle.count());
        const Vec3d centre{coarse.x.back(), coarse.y.back(), coarse.z.back()};
        cluster.x = coarse.x.back(), cluster.y = coarse.y.back(), cluster.z = coarse.z.back();
        double radius = 0;
        for (int i = first_middle; i < middle.count(); ++i)
            radius = std::max(radius, length(Vec3d{middle.x[i], middle.y[i], middle.z[i]} - centre));
        // A spread of sigma moves K ~ s^-4 by 8 sigma^2 / s^2 at distance s, and anything by (sigma / b)^2.
        const auto beyond = [&](double spread, double away) { return float(spread < 0.002 * b ? 2 : std::cos(std::min(away + radius, k_pi))); };
        cluster.spread = float(radius + 1.5 * texel_angle);
        cluster.cos_coarse = beyond(radius + 0.5 * texel_angle, 50 * (radius + 0.5 * texel_angle));
        cluster.cos_middle = beyond(0.5 * texel_angle, 30 * texel_angle);
        lights.clusters.push_back(cluster);
    }
    lights.clusters.push_back({0, 0, 1, 2, 2, 0, coarse.count(), middle.count(), fine.count()});
    // One array: coarse, middle, fine.
    lights.points = coarse;
    lights.points.append(middle);
    lights.points.append(fine);
    for (auto& c : lights.clusters) {
        c.middle += coarse.count();
        c.fine += coarse.count() + middle.count();
    }
    return lights;
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
