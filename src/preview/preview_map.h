#pragma once

#include "domelight/image.h"
#include "domelight/prefilter.h"
#include "domelight/vec.h"

#include <vector>

namespace domelight {

/// A map made small and quick to look up: faces of at most `most` texels (lat-long: 2 most rows), averaged over boxes,
/// with a border taken from the neighbours so that bilinear look-ups go on across edges.
class PreviewMap {
  public:
    PreviewMap() = default;
    PreviewMap(const FilteredMap& map, int most);
    /// From a lat-long image; `world_to_source` turns directions before they are looked up.
    PreviewMap(ImageView<const float> latlong, int most, const Mat3& world_to_source = {});

    bool empty() const { return texels_.empty(); }
    bool is_cube() const { return cube_; }
    /// Bilinear value in a direction (any length but 0).
    Vec3f sample(const Vec3f& d) const;
    /// Bilinear value where a lat-long picture in the default convention has (u, v).
    Vec3f sample_latlong(float u, float v) const;
    /// Bilinear value on a cube's face at (u, v).
    Vec3f sample_face(int face, float u, float v) const;

  private:
    void make_cube(const Cubemap& cube, int most);
    void make_latlong(ImageView<const float> image, int most);
    Vec3f bilinear(const float* origin, int stride, float x, float y) const;

    bool cube_ = false, turned_ = false;
    int width_ = 0, height_ = 0;  ///< without the border
    Mat3 turn_;
    std::vector<float> texels_;  ///< RGB, (width_ + 2) x (height_ + 2), six times for a cube
};

}  // namespace domelight
