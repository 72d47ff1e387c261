#pragma once

#include "domelight/image/image.h"

namespace domelight {

/// Moves texels so that texture(cube, M d) gives what texture(cube, d) gave, M negating x, negating z, or exchanging y
/// and z. Each is its own inverse.
void mirror_cube_x(Cubemap& cube);
void mirror_cube_z(Cubemap& cube);
void swap_cube_yz(Cubemap& cube);

}  // namespace domelight
