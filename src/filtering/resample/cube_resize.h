#pragma once

#include "domelight/image/image.h"

namespace domelight::area {

/// area_resample_cube where the axes stay as they are, about seventy times as fast as plain_cube_to_cube: a texel of
/// the result is a rectangle on the plane of one face, and its weights are those of the texels at the same place of the
/// other faces.
Cubemap resize_cube(const Cubemap& source, int size, int threads);

}  // namespace domelight::area
