#pragma once

#include "domelight/base/vec.h"
#include "domelight/image/image.h"
#include "domelight/projection/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace domelight {

/// The source that every filter and mean refers to: the bilinear reconstruction of a lat-long image. u wraps; v clamps,
/// so that the half rows at the poles are constant in v.
///
/// It consists of (height + 1) x width patches on which it is bilinear in (phi, theta). Patch row r lies between the
/// centres of texel rows r - 1 and r (the first and the last are the half rows); patch column x between those of texels
/// x and x + 1.
class ReferenceSource {
  public:
    /// RGB, at least 1 x 1.
    explicit ReferenceSource(ImageView<const float> latlong);

    int width() const { return image_.width; }
    int height() const { return image_.height; }
    int patch_rows() const { return image_.height + 1; }
    /// Polar angles between which patch row `r` lies.
    double theta_begin(int r) const { return r == 0 ? 0 : (r - 0.5) * k_pi / image_.height; }
    double theta_end(int r) const { return r == image_.height ? k_pi : (r + 0.5) * k_pi / image_.height; }
    /// Azimuth at which patch column `x` begins; it is `patch_width()` wide.
    double phi_begin(int x) const { return ((x + 0.5) / image_.width - 0.5) * 2 * k_pi; }
    double patch_width() const { return 2 * k_pi / image_.width; }

    /// Radiance at the corners of a patch: (phi, theta) at (begin, begin), (end, begin), (begin, end), (end, end).
    std::array<Vec3d, 4> corners(int x, int r) const {
        const int next = x + 1 == image_.width ? 0 : x + 1;
        const int above = std::max(r - 1, 0), below = std::min(r, image_.height - 1);
        return {texel(x, above), texel(next, above), texel(x, below), texel(next, below)};
    }
    Vec3d texel(int x, int y) const {
        const float* p = image_.at(x, y);
        return {p[0], p[1], p[2]};
    }

    /// Radiance from a direction (any length).
    Vec3d lookup(const Vec3d& direction) const;
    /// Mean over the sphere: (1 / 4 pi) ∫ g dω.
    const Vec3d& mean() const { return mean_; }
    /// a_lm = ∫ g Y_lm dω for l < bands, the basis turned by `world_to_source`: Gauss-Legendre on each patch.
    std::vector<Vec3d> spherical_harmonics(int bands, const Mat3& world_to_source, int threads) const;

  private:
    ImageView<const float> image_;
    Vec3d mean_;
};

}  // namespace domelight
