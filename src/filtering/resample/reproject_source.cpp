#include "filtering/resample/reproject_source.h"

#include "domelight/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace domelight::reproject_detail {

namespace {

/// The parabola mean + slope xi + curve (xi^2 - 1/12).
struct Parabola {
    double slope = 0, curve = 0;
};

/// The value on the edge between b and c from the means of four texels in a row, exact for cubics; within b and c.
double edge_value(double a, double b, double c, double d) {
    const double e = (7 * (b + c) - (a + d)) / 12;
    return std::clamp(e, std::min(b, c), std::max(b, c));
}

/// The piecewise parabolic method's function of a texel from its and its neighbours' means: monotone, flat at extrema.
/// (Colella and Woodward 1984, eqs. 1.6 to 1.10.)
Parabola parabola(double a, double b, double c, double d, double e) {
    double left = edge_value(a, b, c, d), right = edge_value(b, c, d, e);
    if ((right - c) * (c - left) <= 0) return {};
    const double rise = right - left, off = rise * (c - 0.5 * (left + right));
    if (off > rise * rise / 6) left = 3 * c - 2 * right;
    if (off < -rise * rise / 6) right = 3 * c - 2 * left;
    return {right - left, 3 * (left + right - 2 * c)};
}

/// Both scaled so that the least values together are no less than a tenth of the mean.
void keep_positive(double mean, Parabola& across, Parabola& down) {
    const auto depth = [](const Parabola& p) {  // monotone: the least is at an end
        return 0.5 * std::abs(p.slope) - p.curve / 6;
    };
    const double sum = depth(across) + depth(down), most = 0.9 * std::abs(mean);
    if (sum <= most) return;
    const double s = most / sum;
    across = {across.slope * s, across.curve * s};
    down = {down.slope * s, down.curve * s};
}

}  // namespace

Source::Source(const ProjectedImage& image, int threads)
    : projection_(image.projection),
      width_(image.width()),
      height_(image.height()),
      rows_alike_(image.projection.shape().wraps() && image.projection.grid() != SampleGrid::both_on_edges),
      black_beyond_(image.projection.shape().coverage() < 3 * k_pi),
      padded_(width_ + 2 * k_border, projection_.charts() * (height_ + 2 * k_border) + k_slack_rows, 3) {
    parallel_for(charts() * height_, threads, [&](int row) {
        const int chart = row / height_, y = row % height_;
        std::copy_n(image.pixels.row(row), 3 * width_,
                    padded_.at(k_border, chart * (height_ + 2 * k_border) + y + k_border));
    });
    for (int c = 0; c < charts(); ++c) fill_border(image, c);
    solid_angle_.resize(rows_alike_ ? std::size_t(height_) : std::size_t(width_) * height_);
    parallel_for(height_, threads, [&](int y) {
        const auto omega = [&](int x) { return projection_.texel_solid_angle(x, y, width_, height_); };
        if (rows_alike_)
            solid_angle_[std::size_t(y)] = omega(0);
        else
            for (int x = 0; x < width_; ++x) solid_angle_[std::size_t(y) * width_ + x] = omega(x);
    });
}

void Source::fill_border(const ProjectedImage& image, int chart) {
    const auto fill = [&](int x, int y) {
        const Vec3d d = projection_.direction(chart, {(x + 0.5) / width_, (y + 0.5) / height_});
        const ProjectionPoint p = projection_.locate(d);
        const int i = std::clamp(int(p.uv.u * width_), 0, width_ - 1),
                  j = std::clamp(int(p.uv.v * height_), 0, height_ - 1);
        std::copy_n(image.pixels.at(i, p.chart * height_ + j), 3,
                    padded_.at(x + k_border, chart * (height_ + 2 * k_border) + y + k_border));
    };
    for (int k = 1; k <= k_border; ++k) {
        for (int x = -k_border; x < width_ + k_border; ++x) fill(x, -k), fill(x, height_ - 1 + k);
        for (int y = 0; y < height_; ++y) fill(-k, y), fill(width_ - 1 + k, y);
    }
}

Place Source::in_texels(int chart, UV uv, int region, bool shown) const {
    // Samples on the edges: texel i covers (i - 1/2) / (n - 1) to (i + 1/2) / (n - 1).
    const auto position = [](double u, int n, bool on_edges) { return on_edges && n > 1 ? u * (n - 1) + 0.5 : u * n; };
    const SampleGrid grid = projection_.grid();
    return {chart, position(uv.u, width_, grid == SampleGrid::both_on_edges),
            position(uv.v, height_, grid != SampleGrid::centres), region, shown};
}

Place Source::locate(const Vec3d& world) const {
    const Vec3d d = projection_.world_to_picture() * world;
    const ProjectionPoint p = projection_.shape().locate(d);
    return in_texels(p.chart, p.uv, projection_.shape().region(d), p.shown);
}

Place Source::locate_near(const Vec3d& world, const Place& near) const {
    const UV uv = projection_.shape().locate_in(near.chart, near.region, projection_.world_to_picture() * world);
    return in_texels(near.chart, uv, near.region, near.shown);
}

Cell Source::cell(int chart, int x, int y) const {
    x = this->column(x), y = std::clamp(y, 0, height_ - 1);
    const float *row[5], *column[5];
    for (int k = 0; k < 5; ++k) row[k] = texel(chart, x + k - 2, y), column[k] = texel(chart, x, y + k - 2);
    double value[5][3];
    const double density_slope = this->density_slope(y);
    for (int c = 0; c < 3; ++c) {
        const double mean = row[2][c];
        Parabola across = parabola(row[0][c], row[1][c], mean, row[3][c], row[4][c]),
                 down = parabola(column[0][c], column[1][c], mean, column[3][c], column[4][c]);
        keep_positive(mean, across, down);
        value[0][c] = mean - density_slope * down.slope / 12;
        value[1][c] = across.slope, value[2][c] = down.slope, value[3][c] = across.curve, value[4][c] = down.curve;
    }
    const auto v = [&](int k) { return Vec3d{value[k][0], value[k][1], value[k][2]}; };
    return {v(0), v(1), v(2), v(3), v(4)};
}

Vec3d Source::at(const Place& place) const {
    const double x = std::floor(place.x), y = std::floor(place.y);
    return cell(place.chart, int(x), int(y)).at(place.x - x - 0.5, place.y - y - 0.5);
}

std::optional<ProjectedImage> reduce(const ProjectedImage& image, double target_texel, int threads) {
    std::optional<ProjectedImage> reduced;
    while (true) {
        const ProjectedImage& out = reduced ? *reduced : image;
        const int w = out.width(), h = out.height(), charts = out.projection.charts();
        const double texel = out.projection.shape().coverage() / (double(w) * h * charts);
        if (w % 2 || h % 2 || w < 16 || out.projection.grid() != SampleGrid::centres || 36 * 4 * texel > target_texel)
            return reduced;
        ImageF half(w / 2, h / 2 * charts, 3);
        parallel_for(half.height(), threads, [&](int row) {
            const int y = 2 * (row % (h / 2)), top = row / (h / 2) * h + y;
            std::vector<double> solid_angle(2 * std::size_t(w));
            for (int k = 0; k < 2; ++k)
                out.projection.texel_solid_angles(y + k, w, h,
                                                  std::span(solid_angle).subspan(std::size_t(k) * w, std::size_t(w)));
            for (int x = 0; x < w; x += 2) {
                double omega[4];
                for (int k = 0; k < 4; ++k) omega[k] = solid_angle[std::size_t(k / 2) * w + x + k % 2];
                const double sum = omega[0] + omega[1] + omega[2] + omega[3];
                for (int c = 0; c < 3; ++c) {
                    double light = 0, plain = 0;
                    for (int k = 0; k < 4; ++k) {
                        const float v = out.pixels.at(x + k % 2, top + k / 2)[c];
                        light += omega[k] * v, plain += 0.25 * v;
                    }
                    half.at(x / 2, row)[c] = float(sum > 0 ? light / sum : plain);
                }
            }
        });
        reduced = ProjectedImage{image.projection, std::move(half)};
    }
}

}  // namespace domelight::reproject_detail
