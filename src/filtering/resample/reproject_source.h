#pragma once

#include "domelight/filtering/resample/reproject.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace domelight::reproject_detail {

/// A place in a source picture, in texels of a chart: texel i covers [i, i + 1).
struct Place {
    int chart = 0;
    double x = 0, y = 0;
    int region = 0;  ///< the regions of a chart are separated by seams
    bool shown = true;
};

/// Radiance within a texel, xi and eta from -1/2 to 1/2: mean + across xi + down eta + across2 (xi^2 - 1/12) + down2
/// (eta^2 - 1/12). Its mean by solid angle is the texel's value.
struct Cell {
    Vec3d mean, across, down, across2, down2;
    Vec3d at(double xi, double eta) const {
        return mean + across * xi + down * eta + across2 * (xi * xi - 1.0 / 12) + down2 * (eta * eta - 1.0 / 12);
    }
};

/// A source picture with the functions that reprojection needs.
class Source {
  public:
    Source(const ProjectedImage& image, int threads);

    int width() const { return width_; }
    int height() const { return height_; }
    int charts() const { return projection_.charts(); }
    bool wraps() const { return projection_.shape().wraps(); }
    bool black_beyond() const { return black_beyond_; }

    /// Any number as a column of the picture: wrapped around if the picture wraps, otherwise clamped.
    int column(int x) const { return wraps() ? (x % width_ + width_) % width_ : std::clamp(x, 0, width_ - 1); }

    Place locate(const Vec3d& world) const;
    /// The same with the chart and region of `near` continued.
    Place locate_near(const Vec3d& world, const Place& near) const;
    /// The radiance within a texel as a function. x wraps if the picture does, otherwise it is clamped, as is y.
    Cell cell(int chart, int x, int y) const;
    /// A texel's three channels; up to two texels outside of its chart, which continue it.
    const float* texel(int chart, int x, int y) const {
        return padded_.at(x + k_border, chart * (height_ + 2 * k_border) + y + k_border);
    }
    double solid_angle(int x, int y) const {
        return rows_alike_ ? solid_angle_[std::size_t(y)] : solid_angle_[std::size_t(y) * width_ + x];
    }
    /// The solid angle's density within a texel of row y is 1 + density_slope(y) eta times its mean. (It is 0 except
    /// for lat-long maps, where it matters near the poles.)
    double density_slope(int y) const {
        return rows_alike_ && projection_.grid() == SampleGrid::centres
                   ? k_pi / height_ / std::tan(k_pi * (y + 0.5) / height_)
                   : 0;
    }
    /// Of the texels of all charts.
    double mean_solid_angle() const { return projection_.shape().coverage() / (double(width_) * height_ * charts()); }
    /// The radiance at a position; if no direction is shown there, that of the nearest one.
    Vec3d at(const Place& place) const;

  private:
    static constexpr int k_border = 2;
    /// Rows below the image that SIMD kernels may read.
    static constexpr int k_slack_rows = 1;
    Place in_texels(int chart, UV uv, int region, bool shown) const;
    void fill_border(const ProjectedImage& image, int chart);

    Projection projection_;
    int width_, height_;
    bool rows_alike_, black_beyond_;
    ImageF padded_;  ///< each chart with a border that continues it
    std::vector<double> solid_angle_;
};

/// Halves each chart as long as its texels are narrower than a sixth of the target's. Texels become means by solid
/// angle. Nothing if they are wide enough as they are.
std::optional<ProjectedImage> reduce(const ProjectedImage& image, double target_texel, int threads);

}  // namespace domelight::reproject_detail
