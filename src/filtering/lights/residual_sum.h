#pragma once

#include "filtering/lights/point_lights.h"

namespace domelight::simd {

/// A function of the angle between two unit directions that is 0 but near the horizon and near the axis. Both tables are
/// linear between their entries, and their last entries are 0.
struct ResidualTable {
    const float* ring;  ///< ring[i] at cosine -half_width + 2 half_width i / ring_steps; its first entry is 0 too
    int ring_steps;
    float half_width;
    const float* axis;  ///< axis[i] at chord extent i / axis_steps
    int axis_steps;
    float extent;
};

/// Groups of 16 point lights (LightGroups), and how near to its horizon or axis a direction must be for a group to
/// matter.
struct ResidualGroups {
    const float *x, *y, *z;   ///< centres; a multiple of 16
    const float* ring_limit;  ///< the greatest |cosine| between the centre and a direction; below 0: never
    const float* axis_limit;  ///< the least cosine; over 1: never
    int count;
    PointSet lights;
};

/// rgb[3 i + c] += sum of f(angle(direction_i, p)) power_p[c] over the lights of the groups that matter, for `count`
/// unit directions.
void add_residual_sums(const ResidualGroups& groups, const ResidualTable& table, const float* x, const float* y,
                       const float* z, int count, float* rgb);

}  // namespace domelight::simd
