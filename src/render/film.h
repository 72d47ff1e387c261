#pragma once

#include "domelight/render/render.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace domelight {

constexpr int k_tile = 16;  ///< width and height of a tile in pixels

/// The sums over a pixel's samples.
struct PixelSums {
    Vec3d radiance, squares;
    Vec3f direct, indirect, diffuse, specular, albedo, normal;
    double depth = 0;
    float covered = 0;
    float object = 0;
    int count = 0;
    int non_finite = 0;  ///< of `count`: samples that added nothing, because their radiance was not finite

    /// Whether a sample of this radiance may be added. If it is not finite, it is counted as black instead.
    bool accepts(const Vec3d& sample) {
        if (std::isfinite(sample.x) && std::isfinite(sample.y) && std::isfinite(sample.z)) return true;
        ++count;
        ++non_finite;
        return false;
    }
    /// Standard error of L / (1 + L), from that of L by the derivative.
    double noise() const;
    Vec3d variance_of_mean() const;
};

/// The picture while samples are added to it, tile by tile.
class Film {
  public:
    Film(int width, int height)
        : width_(width),
          height_(height),
          across_((width + k_tile - 1) / k_tile),
          down_((height + k_tile - 1) / k_tile) {
        tiles_.resize(std::size_t(across_) * down_);
        for (int t = 0; t < int(tiles_.size()); ++t) tiles_[t].resize(std::size_t(columns(t)) * rows(t));
    }
    int tiles() const { return int(tiles_.size()); }
    int x0(int t) const { return t % across_ * k_tile; }
    int y0(int t) const { return t / across_ * k_tile; }
    int columns(int t) const { return std::min(k_tile, width_ - x0(t)); }
    int rows(int t) const { return std::min(k_tile, height_ - y0(t)); }
    std::vector<PixelSums>& tile(int t) { return tiles_[t]; }
    const PixelSums& at(int x, int y) const {
        const int t = y / k_tile * across_ + x / k_tile;
        return tiles_[t][std::size_t(y % k_tile) * columns(t) + x % k_tile];
    }
    /// The standard error that decides about more samples: the largest of a pixel's and its neighbours', because a
    /// pixel's own estimate may be too low by chance.
    double noise_about(int x, int y) const {
        double most = 0;
        for (int j = std::max(0, y - 1); j <= std::min(height_ - 1, y + 1); ++j)
            for (int i = std::max(0, x - 1); i <= std::min(width_ - 1, x + 1); ++i)
                most = std::max(most, at(i, j).noise());
        return most;
    }

  private:
    int width_, height_, across_, down_;
    std::vector<std::vector<PixelSums>> tiles_;
};

/// The progress of the whole picture, updated tile by tile. No other thread may write the sums of a tile during its
/// call.
class StatusSums {
  public:
    explicit StatusSums(Film& film) : film_(film), tiles_(std::size_t(film.tiles())) {}
    /// To be called after samples were added to tile t.
    RenderStatus after(int t, double seconds);

  private:
    struct Tile {
        double samples = 0, squared_noise = 0;
        int pixels = 0, with_noise = 0;
    };
    Film& film_;
    std::vector<Tile> tiles_;
    Tile sum_;
};

/// Errors: an invalid size.
Result<void> check_size(int width, int height);
/// Computes the layers from the sums.
RenderResult develop(const Film& film, int width, int height);

}  // namespace domelight
