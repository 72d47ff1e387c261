#pragma once

#include "domelight/base/vec.h"

#include <utility>
#include <vector>

namespace domelight {

namespace simd {

/// Point lights on the sphere: unit directions and RGB powers (radiance times solid angle).
struct PointSet {
    const float *x, *y, *z, *r, *g, *b;
    int count;
};

}  // namespace simd

/// Point lights that represent an environment's few brightest texels, in the source's frame.
struct PointLights {
    std::vector<float> x, y, z, r, g, b;
    int count() const { return int(x.size()); }
    /// A light of radiance `rgb` over `solid_angle` in a unit direction.
    void add(const Vec3d& direction, double solid_angle, const float* rgb) {
        x.push_back(float(direction.x)), y.push_back(float(direction.y)), z.push_back(float(direction.z));
        r.push_back(float(solid_angle * rgb[0])), g.push_back(float(solid_angle * rgb[1])),
            b.push_back(float(solid_angle * rgb[2]));
    }
    /// Adds power to a light.
    void brighten(int i, double solid_angle, const float* rgb) {
        r[i] += float(solid_angle * rgb[0]), g[i] += float(solid_angle * rgb[1]), b[i] += float(solid_angle * rgb[2]);
    }
    /// The lights [from, to) of `p`.
    void append(const PointLights& p, int from, int to) {
        for (auto [mine, theirs] : {std::pair{&x, &p.x}, {&y, &p.y}, {&z, &p.z}, {&r, &p.r}, {&g, &p.g}, {&b, &p.b}})
            mine->insert(mine->end(), theirs->begin() + from, theirs->begin() + to);
    }
    Vec3d place(int i) const { return {x[i], y[i], z[i]}; }
    simd::PointSet view() const { return {x.data(), y.data(), z.data(), r.data(), g.data(), b.data(), count()}; }
};

}  // namespace domelight
