#pragma once
// Many cubes of one size in one array, each with a border for lookups without seams.

#include "domelight/image/image.h"

#include "projection/bilinear.h"
#include "projection/bordered_cube.h"
#include "texture/texel/rgb9e5.h"

#include <algorithm>
#include <array>
#include <vector>

namespace domelight {

/// How CubeStore keeps a texel: RGB in 32 bits.
struct PackedRgb {
    using Value = Vec3f;
    static constexpr int channels = 3;
    std::uint32_t bits = 0;

    static PackedRgb from(const float* p) { return {rgb9e5_from_rgb({p[0], p[1], p[2]})}; }
    Value value() const { return rgb_from_rgb9e5(bits); }
};

/// The same for the two moments of a distance.
struct PackedMoments {
    struct Value {
        float mean = 0, mean_square = 0;
        Value operator*(float s) const { return {mean * s, mean_square * s}; }
        Value operator+(const Value& b) const { return {mean + b.mean, mean_square + b.mean_square}; }
    };
    static constexpr int channels = 2;
    Value moments;

    static PackedMoments from(const float* p) { return {{p[0], p[1]}}; }
    Value value() const { return moments; }
};

/// Cubes of one size. Each face has a border of one texel from across its edges, as BorderedCube has.
template <typename Texel>
class CubeStore {
  public:
    using Value = typename Texel::Value;

    CubeStore() = default;
    CubeStore(int size, int count)
        : size_(size), border_(border_sources(size)), texels_(std::size_t(count) * border_.size()) {}

    int size() const { return size_; }
    std::size_t bytes() const { return texels_.size() * sizeof(Texel); }

    /// Stores a cube. `cube`: size x 6 size texels of Texel::channels floats, the faces one below the other.
    void set(int index, const float* cube) {
        Texel* out = cube_at(index);
        for (std::size_t i = 0; i < border_.size(); ++i)
            if (border_[i] >= 0) out[i] = Texel::from(cube + std::ptrdiff_t(Texel::channels) * border_[i]);
        const int across = size_ + 2;
        for (int f = 0; f < 6; ++f)
            for (const int y : {-1, size_})
                for (const int x : {-1, size_}) set_corner(out + std::ptrdiff_t(f) * across * across, x, y);
    }

    Value texel(int index, int face, int column, int row) const {
        const int across = size_ + 2;
        return texels_[std::size_t(index) * border_.size() + (std::size_t(face) * across + row + 1) * across + column +
                       1]
            .value();
    }

    /// The four texels around a point: upper left, upper right, lower left, lower right.
    std::array<Value, 4> texels(int index, const CubeTap& tap) const {
        const int across = size_ + 2;
        const Texel* a = texels_.data() + std::size_t(index) * border_.size() +
                         (std::size_t(tap.face) * across + tap.row + 1) * across + tap.column + 1;
        return {a[0].value(), a[1].value(), a[across].value(), a[across + 1].value()};
    }

    /// The cube as it is kept, of RGB.
    Cubemap cube(int index) const {
        Cubemap cube(size_, 3);
        const Texel* texels = texels_.data() + std::size_t(index) * border_.size();
        for (std::size_t i = 0; i < border_.size(); ++i) {
            if (border_[i] < 0) continue;  // a texel of the border is a copy, with the same value
            const Vec3f v = texels[i].value();
            float* out = cube.pixels().data() + std::ptrdiff_t(3) * border_[i];
            out[0] = v.x, out[1] = v.y, out[2] = v.z;
        }
        return cube;
    }

    /// Bilinear.
    Value look_up(int index, const Vec3f& direction) const {
        const CubeTap tap = cube_tap(size_, direction);
        const std::array<Value, 4> v = texels(index, tap);
        return (v[0] * (1 - tap.s) + v[1] * tap.s) * (1 - tap.t) + (v[2] * (1 - tap.s) + v[3] * tap.s) * tap.t;
    }

  private:
    /// For each texel of a bordered cube the texel of the cube that it is a copy of; -1 at the corners of the border.
    static std::vector<int> border_sources(int size) {
        std::vector<int> sources;
        const auto outside = [&](int i) { return i < 0 || i == size; };
        for (int f = 0; f < 6; ++f)
            for (int y = -1; y <= size; ++y)
                for (int x = -1; x <= size; ++x)
                    sources.push_back(outside(x) && outside(y) ? -1 : texel_or_across(size, f, x, y));
        return sources;
    }

    /// A corner of the border is the mean of the three texels that meet there.
    void set_corner(Texel* face, int x, int y) const {
        const int inside_x = std::clamp(x, 0, size_ - 1), inside_y = std::clamp(y, 0, size_ - 1);
        const auto at = [&](int i, int j) -> Texel& { return face[(j + 1) * (size_ + 2) + i + 1]; };
        const Value sum = at(inside_x, inside_y).value() + at(x, inside_y).value() + at(inside_x, y).value();
        at(x, y) = packed(sum * (1.f / 3));
    }
    static Texel packed(const Vec3f& v) { return {rgb9e5_from_rgb(v)}; }
    static Texel packed(const PackedMoments::Value& v) { return {v}; }

    Texel* cube_at(int index) { return texels_.data() + std::size_t(index) * border_.size(); }

    int size_ = 0;
    std::vector<int> border_;
    std::vector<Texel> texels_;
};

}  // namespace domelight
