#pragma once
// The environment as reflection mapping binds it: resampled into one texture, looked up bilinearly.

#include "domelight/projection/projection.h"
#include "domelight/render/shading/shading.h"

#include "projection/bordered_cube.h"

#include <optional>

namespace domelight {

/// Bilinear across a bordered cube's faces; direction of any length but 0.
Vec3f look_up(const BorderedCube& cube, const Vec3f& direction);

/// An environment in one of the textures that MapLookup lists. Each texel is the source's mean over it: by exact
/// overlap for cube and lat-long, over 8 x 8 points for the two discs.
class EnvironmentMap {
  public:
    /// `source` must outlive the map: MapLookup::environment reads it. size: as ShadingOptions::lookup_size.
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
