#pragma once

#include "domelight/base/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace domelight {

/// Cuts a polygon into triangles: `corners` are indices of `positions`, and three indices a triangle are added to
/// `out`, in the same direction of turning. Convex polygons become fans; concave ones are triangulated by ear clipping
/// (Meisters 1975); those of more than 64 corners become fans too. Precondition: every corner is below
/// positions.size().
void triangulate(std::span<const std::uint32_t> corners, std::span<const Vec3f> positions,
                 std::vector<std::uint32_t>& out);

}  // namespace domelight
