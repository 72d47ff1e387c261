#pragma once
// Arcs of circles on the unit sphere: the borders of output texels, seen from the source.

#include "domelight/vec.h"

#include <cmath>
#include <vector>

namespace domelight::area {

/// An oriented arc p(s) = centre + e1 cos s + e2 sin s, s0 <= s <= s1, of a circle on the unit sphere. e1 and e2 are
/// orthogonal, of the circle's radius; a great circle has its centre at 0.
struct Arc {
    Vec3d centre, e1, e2;
    double s0 = 0, s1 = 0;

    Vec3d at(double s) const { return centre + e1 * std::cos(s) + e2 * std::sin(s); }
    Vec3d derivative(double s) const { return e2 * std::cos(s) - e1 * std::sin(s); }
    bool is_great() const { return centre == Vec3d{}; }
    double radius() const { return length(e1); }
};

/// The shorter great-circle arc from `a` to `b` (unit vectors, less than pi apart).
inline Arc great_arc(const Vec3d& a, const Vec3d& b) {
    const Vec3d across = b - a * dot(a, b);
    const double sine = length(across);
    return {{}, a, sine > 0 ? across / sine : Vec3d{}, 0, std::atan2(sine, dot(a, b))};
}

/// Appends the parameters strictly inside the arc at which a cos s + b sin s = c.
inline void solve_circle(const Arc& arc, double a, double b, double c, std::vector<double>& out) {
    const double r = std::hypot(a, b);
    if (!(r > 0) || std::abs(c) > r) return;
    const double base = std::atan2(b, a), offset = std::acos(c / r);
    for (double s : {base - offset, base + offset}) {
        s -= 2 * k_pi * std::floor((s - arc.s0) / (2 * k_pi));  // the first solution at or after s0
        if (s > arc.s0 && s < arc.s1) out.push_back(s);
    }
}

/// Appends the parameters strictly inside the arc at which dot(normal, p) = distance.
inline void cross_plane(const Arc& arc, const Vec3d& normal, double distance, std::vector<double>& out) {
    solve_circle(arc, dot(normal, arc.e1), dot(normal, arc.e2), distance - dot(normal, arc.centre), out);
}

/// The border of texel (x, y) of a cube face of size^2 texels as four great arcs, in the source's frame.
std::vector<Arc> cube_texel_border(int face, int x, int y, int size, const Mat3& world_to_source);

/// The border of the part [u0, u1] x [v0, v1] of a lat-long image, in the source's frame: two meridians and up to two
/// parallels.
std::vector<Arc> latlong_border(double u0, double u1, double v0, double v1, const Mat3& world_to_source);

}  // namespace domelight::area
