#pragma once

#include "simd/zonal_sum.h"

namespace domelight::simd {

/// A kernel as a function of the chord s between two unit directions: GGX in closed form (table.values null), else a table over the angle.
///   scale max(c, 0) / (alpha^2 (1 + c) + 1 - c)^2, c = 1 - s^2 / 2.
struct DirectKernel {
    float scale, alpha2;
    ZonalTable table;
};

/// A cluster of lights at three levels of detail, each a range of one PointSet.
struct LightCluster {
    float x, y, z;                 ///< unit direction of the middle
    float cos_coarse, cos_middle;  ///< of the angles beyond which the coarse and the middle level will do
    float spread;                  ///< radius, radians; a cluster on the horizon of a direction, where kernels have their kink, is taken finely
    int coarse, middle, fine;      ///< first points of the three levels; the next cluster's follow
};

/// rgb[3 i + c] += sum over lights of kernel(angle) power_c, for `count` unit directions; `clusters` has cluster_count + 1 entries.
void add_direct_lights(const LightCluster* clusters, int cluster_count, const PointSet& points, const DirectKernel& kernel, const float* x,
                       const float* y, const float* z, int count, float* rgb);

}  // namespace domelight::simd
