#pragma once

#include "domelight/probe/probe_set.h"

#include "probe/cube_store.h"

namespace domelight {

/// How far surfaces that are flat, or meet in a corner, are from the truth at most by distance_between_texels(), as a
/// part of the distance.
inline float distance_tolerance(int size) {
    return 0.3f / float(size);
}

/// The moments of the distance between the centres of texels, which hold averages over their area.
///
/// The mean is exact for walls, however steeply they are seen: on a face of a cube, the reciprocal of the depth z along
/// the face's axis is linear across a plane, because a plane n.p = c is met by z (s, t, 1) at 1 / z = (n.x s + n.y t +
/// n.z) / c. Where walls meet in a corner, 1 / z is the largest of their linear functions. So it is that of the planes
/// through each of the four texels and its two neighbours on the far side of the direction, and no more than bilinear
/// interpolation gives.
///
/// The variance that a slope causes within a texel says nothing about what hides what. What remains without it is
/// interpolated: that of edges, leaves and the like.
DistanceMoments distance_between_texels(const CubeStore<PackedMoments>& cubes, int index, const Vec3f& direction);

}  // namespace domelight
