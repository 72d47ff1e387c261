#pragma once
// The environment for reflection mapping: resampled into one texture and looked up bilinearly.

#include "domelight/projection/projection.h"
#include "domelight/render/shading/shading.h"

#include "projection/bordered_cube.h"

#include <optional>

namespace domelight {

/// An environment in one of the textures of MapLookup. Each texel is the mean of the source over it: by exact overlap
/// for cube and lat-long, over 8 x 8 points for the two kinds of disc.
class EnvironmentMap {
  public:
    /// `source` must outlive the map, because it is used by MapLookup::environment. size: as
    /// ShadingOptions::lookup_size.
    EnvironmentMap(const EnvironmentSampler& source, MapLookup lookup, int size, int threads);
    /// Radiance from a direction in the world, of any length but 0.
    Vec3f radiance(const Vec3f& direction) const;

  private:
    const EnvironmentSampler& source_;
    MapLookup lookup_;
    std::optional<BorderedCube> cube_;
    ImageF image_;  ///< lat-long; sphere map
    ImageF back_;   ///< dual paraboloid: image_ is the front
};

}  // namespace domelight
