#pragma once

#include "domelight/image/image.h"
#include "domelight/projection/projection.h"

#include "projection/bordered_cube.h"

namespace domelight {

/// The RGB value at a point of an image, bilinear between texel centres. v clamps; u wraps around or clamps.
Vec3f bilinear(ImageView<const float> image, UV uv, bool wrap);

/// The four texels of a cube's face that a direction lies between: those at (column, row), to the right of it and below.
/// Column and row are -1 .. size - 1, so that the border of a face takes part.
struct CubeTap {
    int face, column, row;
    float s, t;  ///< where the direction lies between them, 0 .. 1 to the right and down
};
CubeTap cube_tap(int size, const Vec3f& direction);

/// Bilinear lookup across the faces of a bordered cube; the direction may have any length but 0.
Vec3f look_up(const BorderedCube& cube, const Vec3f& direction);

}  // namespace domelight
