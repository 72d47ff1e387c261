#pragma once

#include "filtering/lights/point_lights.h"

namespace domelight::simd {

/// A function of the angle between two directions, linear between table[i] = f(pi i / steps), i = 0..steps (and one
/// more entry after it).
struct ZonalTable {
    const float* values;
    int steps;
};

/// A kernel as a function of the chord s between two unit directions: GGX in closed form (table.values null), else a
/// table over the angle.
///   scale max(c, 0) / (alpha^2 (1 + c) + 1 - c)^2, c = 1 - s^2 / 2.
struct DirectKernel {
    float scale, alpha2;
    ZonalTable table;
};

/// A node of a tree of lights in depth-first order: points that represent all lights below it wherever that is accurate
/// enough.
struct LightNode {
    float x, y, z;     ///< unit direction of the centre
    float cos_far;     ///< the points are accurate for directions farther away than this; over 1: for all
    float radius;      ///< radians; a node that crosses the horizon of a direction, where kernels have a kink, is
                       ///< replaced by its children
    int first, count;  ///< points
    int skip;          ///< the next node outside this subtree
};

/// rgb[3 i + c] += sum over lights of kernel(angle) power_c, for `count` unit directions.
void add_direct_lights(const LightNode* nodes, int node_count, const PointSet& points, const DirectKernel& kernel,
                       const float* x, const float* y, const float* z, int count, float* rgb);

}  // namespace domelight::simd
