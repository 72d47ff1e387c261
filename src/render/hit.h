#pragma once
// What a ray meets.

#include "domelight/scene/scene.h"

#include <cmath>
#include <limits>

namespace domelight {

/// The point where a ray hit a surface.
struct Hit {
    float distance = 0;
    int instance = -1;  ///< -1: none
    int triangle = 0;
    float u = 0, v = 0;      ///< barycentric: (1 - u - v) a + u b + v c
    Vec3f geometric_normal;  ///< in the world, not of unit length, towards the front
};

struct Ray {
    Vec3f origin, direction;
    float near = 0;
    float far = std::numeric_limits<float>::infinity();
};

/// Continues a ray behind the surface that it hit.
inline void pass(Ray& ray, const Hit& hit) {
    ray.near = std::nextafter(hit.distance + 4e-6f * (1 + hit.distance), 1e30f);
}

}  // namespace domelight
