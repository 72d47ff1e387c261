#pragma once

#include "domelight/base/vec.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/image/image.h"

#include "preview/texel4.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace domelight {

/// A place on a map of some layout, whatever its size: a cube's face and the point on it, or a lat-long image's point.
/// Both coordinates 0..1. Pictures of several maps share their places.
struct MapPlace {
    std::int32_t face = 0;
    float u = 0, v = 0;
};

/// Where a cube has a direction (any length but 0). In float: to about 1e-7 of a face.
inline MapPlace cube_place(const Vec3f& d) {
    const float ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z);
    float s, t, most;
    int face;
    // OpenGL 4.6, table 8.19.
    if (ax >= ay && ax >= az) {
        face = d.x < 0, most = ax, s = d.x < 0 ? d.z : -d.z, t = -d.y;
    } else if (ay >= az) {
        face = 2 + (d.y < 0), most = ay, s = d.x, t = d.y < 0 ? -d.z : d.z;
    } else {
        face = 4 + (d.z < 0), most = az, s = d.z < 0 ? -d.x : d.x, t = -d.y;
    }
    const float scale = 0.5f / most;
    return {face, s * scale + 0.5f, t * scale + 0.5f};
}

MapPlace latlong_place(const Vec3f& d);

/// "512²" of a cube, "1024 × 512" of a lat-long image.
std::string size_text(const FilteredMap& map);

/// A map reduced for fast lookups: faces of at most `most` texels (lat-long: 2 most rows), averaged over boxes, with a
/// border taken from the neighbours so that bilinear look-ups go on across edges.
class PreviewMap {
  public:
    PreviewMap() = default;
    PreviewMap(const FilteredMap& map, int most);
    /// From a lat-long image; `world_to_source` turns directions before they are looked up.
    PreviewMap(ImageView<const float> latlong, int most, const Mat3& world_to_source = {});

    bool empty() const { return texels_.empty(); }
    bool is_cube() const { return cube_; }
    /// Whether a lat-long picture of this map is the map itself.
    bool is_upright_latlong() const { return !cube_ && !turned_; }

    MapPlace place(const Vec3f& d) const {
        return cube_ ? cube_place(d) : latlong_place(turned_ ? Vec3f(turn_ * Vec3d(d)) : d);
    }
    /// Bilinear value at a place of this map's layout.
    Texel4 at(const MapPlace& place) const {
        const float x = place.u * float(width_) + 0.5f, y = place.v * float(height_) + 0.5f;
        const int i = int(x), j = int(y);
        const float fx = x - float(i), fy = y - float(j);
        const Texel4 *a = &texels_[std::size_t(place.face) * std::size_t(block_) + std::size_t(j * (width_ + 2) + i)],
                     *b = a + width_ + 2;
        const auto upper = a[0].v + (a[1].v - a[0].v) * fx, lower = b[0].v + (b[1].v - b[0].v) * fx;
        return {upper + (lower - upper) * fy};
    }
    /// Bilinear value in a direction (any length but 0).
    Vec3f sample(const Vec3f& d) const { return at(place(d)).rgb(); }

    /// Replaces every texel by `change(texel)`.
    template <typename Change>
    void transform(const Change& change) {
        for (Texel4& t : texels_) t = change(t);
    }

  private:
    void make_cube(const FilteredMap& cube, int most);
    void make_latlong(ImageView<const float> image, int most);

    bool cube_ = false, turned_ = false;
    int width_ = 0, height_ = 0;  ///< without the border
    int block_ = 0;               ///< texels of a face with its border
    Mat3 turn_;
    std::vector<Texel4> texels_;  ///< (width_ + 2) x (height_ + 2), six times for a cube
};

}  // namespace domelight
