#pragma once

#include "domelight/image/image.h"
#include "domelight/projection/projection.h"

#include "projection/bordered_cube.h"

namespace domelight {

/// The RGB value at a point of an image, bilinear between texel centres. v clamps; u wraps around or clamps.
Vec3f bilinear(ImageView<const float> image, UV uv, bool wrap);

/// Bilinear lookup across the faces of a bordered cube; the direction may have any length but 0.
Vec3f look_up(const BorderedCube& cube, const Vec3f& direction);

}  // namespace domelight
