#pragma once

#include <vector>

namespace domelight {

/// cube_solid_angle() of every texel of a face of `size`^2 texels, row by row (sr). Neighbours share corners, so this
/// takes a quarter of the time of a call for each texel. `threads` 0: all.
std::vector<double> cube_solid_angles(int size, int threads);

}  // namespace domelight
