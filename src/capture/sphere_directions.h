#pragma once

#include "domelight/base/vec.h"

#include <vector>

namespace domelight {

/// Directions spread evenly over the sphere (a Fibonacci spiral), unit length; each stands for 4 pi / count steradian.
std::vector<Vec3f> sphere_directions(int count);

}  // namespace domelight
