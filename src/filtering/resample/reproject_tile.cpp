#include "filtering/resample/reproject_tile.h"

#include <algorithm>
#include <cmath>

namespace domelight::reproject_detail {

SourceBox source_box(const Block& block) {
    const double slack = 0.02 * std::max(block.most_x - block.least_x, block.most_y - block.least_y) + 1;
    return {int(std::floor(block.least_x - slack)), int(std::floor(block.least_y - slack)),
            int(std::ceil(block.most_x + slack)), int(std::ceil(block.most_y + slack))};
}

bool TileIntegrator::prepare(const Source& source, int chart, const SourceBox& box) {
    if (box.too_large()) return false;
    const int x0 = box.x0, y0 = box.y0;
    x0_ = x0, y0_ = y0, width_ = box.width(), height_ = box.height();
    columns_.resize(std::size_t(width_) * height_);
    density_slope_.resize(std::size_t(height_));
    is_even_ = true;
    for (int y = 0; y < height_; ++y) {
        const double slope_here = source.density_slope(std::clamp(y0 + y, 0, source.height() - 1));
        density_slope_[std::size_t(y)] = slope_here;
        is_even_ = is_even_ && slope_here == 0;
        Flux constant;
        Vec3d slope, curve;
        for (int x = 0; x < width_; ++x) {
            Column& c = columns_[std::size_t(y) * width_ + x];
            c.constant = constant, c.slope = slope, c.curve = curve;
            c.cell = source.cell(chart, x0 + x, y0 + y);
            c.solid_angle = source.solid_angle(source.column(x0 + x), std::clamp(y0 + y, 0, source.height() - 1));
            constant.light += c.cell.mean * c.solid_angle;
            constant.solid_angle += c.solid_angle;
            slope += c.cell.down * c.solid_angle;
            curve += c.cell.down2 * c.solid_angle;
        }
    }
    return true;
}

Flux TileIntegrator::potential(const Column& c, double xi, double eta) const {
    const double run = xi + 0.5, square = eta * eta - 1.0 / 12;
    const Vec3d light = (c.cell.mean + c.cell.down * eta + c.cell.down2 * square) * run +
                        c.cell.across * (0.5 * (xi * xi - 0.25)) + c.cell.across2 * (xi * (xi * xi - 0.25) / 3);
    return {c.constant.light + c.slope * eta + c.curve * square + light * c.solid_angle,
            c.constant.solid_angle + c.solid_angle * run};
}

Flux TileIntegrator::along(double ax, double ay, double bx, double by) const {
    Flux sum;
    const double dx = bx - ax, dy = by - ay;
    if (dy == 0) return sum;
    // From one crossing of a row or column of texel edges to the next.
    const double step_x = dx == 0 ? 2 : 1 / std::abs(dx), step_y = 1 / std::abs(dy);
    int i = int(std::floor(ax)), j = int(std::floor(ay));
    if (dx < 0 && ax == i) --i;
    if (dy < 0 && ay == j) --j;
    double next_x = dx == 0 ? 2 : (dx > 0 ? i + 1 - ax : ax - i) * step_x,
           next_y = (dy > 0 ? j + 1 - ay : ay - j) * step_y;
    for (double s = 0; s < 1;) {
        const double end = std::min({next_x, next_y, 1.0});
        const int x = std::clamp(i - x0_, 0, width_ - 1), y = std::clamp(j - y0_, 0, height_ - 1);
        const Column& c = columns_[std::size_t(y) * width_ + x];
        const double middle = 0.5 * (s + end), half = 0.5 * (end - s);
        // Exact to the fifth degree if the density has a slope; otherwise the third suffices.
        constexpr double two[2] = {-0.5773502691896257, 0.5773502691896257},
                         three[3] = {-0.7745966692414834, 0, 0.7745966692414834},
                         three_weights[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
        const double density_slope = density_slope_[std::size_t(y)];
        const auto add = [&](double node, double weight) {
            const double t = middle + node * half, eta = ay + t * dy - (y + y0_) - 0.5;
            sum.add(weight * half * dy * (1 + density_slope * eta), potential(c, ax + t * dx - (x + x0_) - 0.5, eta));
        };
        if (half > 0 && is_even_)
            for (const double node : two) add(node, 1);
        else if (half > 0)
            for (int k = 0; k < 3; ++k) add(three[k], three_weights[k]);
        s = end;
        if (next_x <= end) i += dx > 0 ? 1 : -1, next_x += step_x;
        if (next_y <= end) j += dy > 0 ? 1 : -1, next_y += step_y;
    }
    return sum;
}

void TileIntegrator::integrate(const Block& block, const PlaceOf& place, SideSums& sums) const {
    const auto side = [&](int i, int j, int di, int dj) -> SideSum {
        const std::size_t a = block.corner(i, j), b = block.corner(i + di, j + dj);
        Flux sum;
        SourcePoint from{block.x[a], block.y[a]};
        for (int k = 1; k <= block.parts; ++k) {
            const double s = double(k) / block.parts;
            const SourcePoint to = k == block.parts ? SourcePoint{block.x[b], block.y[b]}
                                                    : place(block.x0 + i + s * di, block.y0 + j + s * dj);
            sum.add(1, along(from.x, from.y, to.x, to.y));
            from = to;
        }
        return {sum.light.x, sum.light.y, sum.light.z, sum.solid_angle};
    };
    sums.across.clear(), sums.down.clear();
    for (int j = 0; j < block.ny; ++j)
        for (int i = 0; i + 1 < block.nx; ++i) sums.across.push_back(side(i, j, 1, 0));
    for (int j = 0; j + 1 < block.ny; ++j)
        for (int i = 0; i < block.nx; ++i) sums.down.push_back(side(i, j, 0, 1));
}

}  // namespace domelight::reproject_detail
