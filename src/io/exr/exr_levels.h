#pragma once
// The pixels of OpenEXR images before they are encoded: cubes in OpenEXR's orientation, and chains of levels.

#include "domelight/base/result.h"
#include "domelight/image/image.h"

#include <span>

namespace domelight {

/// Faces from OpenGL's orientation to OpenEXR's.
ImageF exr_cube_strip(ImageView<const float> strip);

/// An error unless each level is half as large as the one before, rounded down, and, of a cube, a strip of six faces.
Result<void> check_exr_level_sizes(std::span<const ImageView<const float>> levels, bool cube);

/// A copy of a level as the file holds it.
ImageF exr_level(ImageView<const float> level, bool cube);

/// The level after `image`, by averaging two by two texels; an odd last row or column is averaged with the one before.
ImageF next_exr_level(const ImageF& image);

}  // namespace domelight
