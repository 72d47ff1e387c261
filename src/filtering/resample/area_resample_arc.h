#pragma once
// Arcs of circles on the unit sphere: the borders of output texels, seen from the source.

#include "domelight/base/vec.h"

#include <cmath>
#include <vector>

namespace domelight::area {

/// An oriented arc p(s) = centre + e1 cos s + e2 sin s, s0 <= s <= s1, of a circle on the unit sphere. e1 and e2 are
/// orthogonal, of the circle's radius; a great circle has its centre at 0.
struct Arc {
    Vec3d centre, e1, e2;
    double s0 = 0, s1 = 0;

    struct Place {
        Vec3d point, derivative;
    };
    Place place(double s) const {
        const double c = std::cos(s), t = std::sin(s);
        return {centre + e1 * c + e2 * t, e2 * c - e1 * t};
    }
    Vec3d at(double s) const { return place(s).point; }
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

/// Appends the parameters strictly inside the arc at which dot(p, a) / dot(p, b) has a turning point (a great circle
/// has none).
inline void turning_points(const Arc& arc, const Vec3d& a, const Vec3d& b, std::vector<double>& out) {
    // (p'.a)(p.b) - (p.a)(p'.b) is of first order in cos s and sin s.
    const auto turn = [&](const Vec3d& p, const Vec3d& q) { return dot(q, a) * dot(p, b) - dot(p, a) * dot(q, b); };
    solve_circle(arc, turn(arc.centre, arc.e2), -turn(arc.centre, arc.e1), -turn(arc.e1, arc.e2), out);
}

/// Gauss-Legendre rules on [-1, 1]: three nodes for short pieces, five for long ones.
struct GaussRule {
    int count;
    double node[5], weight[5];
};
inline constexpr GaussRule k_gauss3{3, {-0.7745966692414834, 0, 0.7745966692414834}, {5.0 / 9, 8.0 / 9, 5.0 / 9}};
inline constexpr GaussRule k_gauss5{
    5,
    {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640},
    {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665, 0.2369268850561891}};

/// The border of texel (x, y) of a cube face of size^2 texels as four great arcs, in the source's frame.
std::vector<Arc> cube_texel_border(int face, int x, int y, int size, const Mat3& world_to_source);

/// The border of the part [u0, u1] x [v0, v1] of a lat-long image, in the source's frame: two meridians and up to two
/// parallels.
std::vector<Arc> latlong_border(double u0, double u1, double v0, double v1, const Mat3& world_to_source);

}  // namespace domelight::area
