#pragma once
// Lat-long files of a bake, as an audit of cubes takes them.

#include "domelight/filtering/resample/reproject.h"
#include "domelight/image/image.h"

namespace domelight {

/// A lat-long level as a cube: each texel is the mean of the level over it. Its faces are as fine as the level at the
/// horizon, a quarter as wide as the image.
Cubemap cube_of_latlong_level(const ProjectedImage& level, int threads);

}  // namespace domelight
