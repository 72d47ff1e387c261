#pragma once

#include "domelight/base/vec.h"

#include <array>

namespace domelight {

/// The point of a triangle that is nearest to another point.
struct ClosestOnTriangle {
    std::array<double, 3> weight{};  ///< barycentric, >= 0, sum 1
    double squared_distance = 0;
};

/// Ericson 2005, "Real-Time Collision Detection", 5.1.5: by the region of the plane in which the point lies.
inline ClosestOnTriangle closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const auto with = [&](double wa, double wb, double wc) {
        const Vec3d d = a * wa + b * wb + c * wc - p;
        return ClosestOnTriangle{{wa, wb, wc}, dot(d, d)};
    };
    const Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
                 d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return with(1, 0, 0);
    if (d3 >= 0 && d4 <= d3) return with(0, 1, 0);
    if (d6 >= 0 && d5 <= d6) return with(0, 0, 1);
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return with(1 - d1 / (d1 - d3), d1 / (d1 - d3), 0);
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return with(1 - d2 / (d2 - d6), 0, d2 / (d2 - d6));
    if (va <= 0 && d4 >= d3 && d5 >= d6) {
        const double t = (d4 - d3) / (d4 - d3 + d5 - d6);
        return with(0, 1 - t, t);
    }
    const double sum = va + vb + vc;
    return with(va / sum, vb / sum, vc / sum);
}

}  // namespace domelight
