#pragma once

#include "domelight/texture/texture.h"

#include <filesystem>

namespace domelight {

/// Float texels of a three-dimensional texture: x runs fastest, then y, then z.
class VolumeTexels {
  public:
    VolumeTexels(int width, int height, int depth) : width_(width), height_(height), depth_(depth) {
        texels_.resize(std::size_t(width) * std::size_t(height) * std::size_t(depth));
    }

    struct Texel {
        float r = 0, g = 0, b = 0, a = 0;
    };
    Texel& at(int x, int y, int z) {
        return texels_[std::size_t(x) + std::size_t(width_) * (std::size_t(y) + std::size_t(height_) * std::size_t(z))];
    }
    int width() const { return width_; }
    int height() const { return height_; }
    int depth() const { return depth_; }
    const std::vector<Texel>& texels() const { return texels_; }

  private:
    int width_, height_, depth_;
    std::vector<Texel> texels_;
};

/// Writes a KTX2 file of one level. `encoding`: rgba16f, or rgb9e5, which leaves the fourth channel out and holds no
/// values below 0. Returns how many texels the encoding had to clip. Errors: those of writing.
Result<std::int64_t> write_volume(const std::filesystem::path& file, const VolumeTexels& volume, Encoding encoding);

}  // namespace domelight
