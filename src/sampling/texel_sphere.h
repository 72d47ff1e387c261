#pragma once

#include "domelight/base/vec.h"
#include "domelight/projection/projection.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace domelight {

/// The texels of a lat-long image as a grid that closes on the sphere: columns wrap, and beyond a pole lies the same
/// row half a turn on. A texel is named by y * width + x.
class TexelSphere {
  public:
    TexelSphere(int width, int height) : width_(width), height_(height) {
        for (int x = 0; x < width; ++x) {
            const double phi = ((x + 0.5) / width - 0.5) * 2 * k_pi;
            around_.push_back({std::cos(phi), std::sin(phi)});
        }
        for (int y = 0; y < height; ++y) {
            const double theta = (y + 0.5) / height * k_pi;
            down_.push_back({std::cos(theta), std::sin(theta)});
            solid_angle_.push_back(latlong_solid_angle(y, width, height));
        }
    }

    int width() const { return width_; }
    int height() const { return height_; }
    std::int64_t size() const { return std::int64_t(width_) * height_; }
    int row(std::int64_t texel) const { return int(texel / width_); }
    int column(std::int64_t texel) const { return int(texel % width_); }
    double solid_angle(std::int64_t texel) const { return solid_angle_[row(texel)]; }
    /// Of the texel's centre, unit length, in the image's frame.
    Vec3d direction(std::int64_t texel) const {
        const auto [c, s] = around_[column(texel)];
        const auto [y, sine] = down_[row(texel)];
        return {sine * c, y, sine * s};
    }
    double sine(int y) const { return down_[y].second; }
    std::int64_t at(const Vec3d& d) const {
        const UV uv = latlong_uv(d);
        return std::int64_t(std::min(int(uv.v * height_), height_ - 1)) * width_ +
               std::min(int(uv.u * width_), width_ - 1);
    }

    /// Calls f(texel) for the eight around it.
    template <typename F>
    void for_each_neighbour(std::int64_t texel, F f) const {
        const int x = column(texel), y = row(texel);
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                if (dx == 0 && dy == 0) continue;
                int yy = y + dy, xx = x + dx + width_;
                if (yy < 0 || yy >= height_) {
                    yy = y;
                    xx += width_ / 2;
                }
                f(std::int64_t(yy) * width_ + xx % width_);
            }
    }

  private:
    int width_, height_;
    std::vector<std::pair<double, double>> around_, down_;  ///< cosine and sine
    std::vector<double> solid_angle_;
};

}  // namespace domelight
