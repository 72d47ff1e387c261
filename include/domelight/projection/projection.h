#pragma once

#include "domelight/base/vec.h"

#include <algorithm>
#include <cmath>

namespace domelight {

/// A point of an image: u to the right, v down, both 0..1.
struct UV {
    double u = 0, v = 0;
};

/// Direction of a lat-long image's point in the default convention: the centre looks along +X, to the right of it lies
/// +Z, row 0 is +Y. u = 1/2 + atan2(z, x) / 2 pi, v = theta / pi with theta from +Y.
inline Vec3d latlong_direction(UV uv) {
    const double phi = (uv.u - 0.5) * 2 * k_pi, theta = uv.v * k_pi, s = std::sin(theta);
    return {s * std::cos(phi), std::cos(theta), s * std::sin(phi)};
}

/// Inverse of latlong_direction. `d` need not be of unit length; u is in [0, 1], v in [0, 1]; at the poles u is 1/2.
inline UV latlong_uv(const Vec3d& d) {
    // Not acos(y): it loses half the digits near the poles.
    return {0.5 + std::atan2(d.z, d.x) / (2 * k_pi), std::atan2(std::hypot(d.x, d.z), d.y) / k_pi};
}

/// Solid angle (sr) of one texel in row `y` of a width x height lat-long image: (2 pi / W)(cos theta_y - cos
/// theta_{y+1}).
double latlong_solid_angle(int y, int width, int height);

/// A face 0..5 (+X -X +Y -Y +Z -Z) of a cube and a point on it.
struct CubePoint {
    int face = 0;
    UV uv;
};

/// Direction (not normalised: the largest component is +-1) of a point of a cube face, OpenGL's orientation:
/// texture(cube, d) returns the radiance arriving from d. (OpenGL 4.6 core specification, table 8.19, solved for the
/// direction.)
inline Vec3d cube_direction(int face, UV uv) {
    const double s = 2 * uv.u - 1, t = 2 * uv.v - 1;
    switch (face) {
        case 0:
            return {1, -t, -s};
        case 1:
            return {-1, -t, s};
        case 2:
            return {s, 1, t};
        case 3:
            return {s, -1, -t};
        case 4:
            return {s, -t, 1};
        default:
            return {-s, -t, -1};
    }
}

/// Inverse of cube_direction for any d != 0. Ties between axes go to x, then y.
CubePoint cube_point(const Vec3d& d);

/// Solid angle (sr) of texel (x, y) of a face of `size`^2 texels, in double (in float the formula is 11 % off at
/// 1024^2).
double cube_solid_angle(int x, int y, int size);

/// A point of a disc that fills a square picture, |p| <= 1 inside: x to the right, y up.
struct DiscPoint {
    double x = 0, y = 0;
    double squared() const { return x * x + y * y; }
};
inline DiscPoint disc_point(UV uv) {
    return {2 * uv.u - 1, 1 - 2 * uv.v};
}
inline UV disc_uv(DiscPoint p) {
    return {0.5 + 0.5 * p.x, 0.5 - 0.5 * p.y};
}

/// OpenGL's sphere map, which is the picture of a mirror ball by a camera far away on +Z. The disc point of a direction
/// d (of any length but 0) is p = h.xy with h = normalize(d / |d| + e_z). The centre shows +Z, right +X, up +Y. The
/// whole rim shows -Z; for d = -Z the right end of the rim is returned. (OpenGL 2.1 specification, 2.11.4; its t runs
/// up.)
inline UV sphere_map_uv(const Vec3d& d) {
    const Vec3d n = d / length(d), h{n.x, n.y, n.z + 1};
    const double side = std::hypot(n.x, n.y);
    // For directions near -Z, 1 + z has no digits left; instead h_z / |h_xy| = (1 + z) / side = side / (1 - z).
    if (n.z >= 0) return disc_uv({h.x / length(h), h.y / length(h)});
    if (side == 0) return disc_uv({1, 0});
    const double slope = side / (1 - n.z), r = 1 / std::sqrt(1 + slope * slope);
    return disc_uv({r * n.x / side, r * n.y / side});
}
/// Inverse of sphere_map_uv, of unit length: d = 2 h_z h - e_z with h = (p, h_z), h_z = sqrt(1 - |p|^2) and p =
/// disc_point(uv). Outside the disc the direction is -Z.
inline Vec3d sphere_map_direction(UV uv) {
    const DiscPoint p = disc_point(uv);
    const double hz2 = std::max(0.0, 1 - p.squared()), hz = std::sqrt(hz2);
    return {2 * hz * p.x, 2 * hz * p.y, 2 * hz2 - 1};
}
/// dω / (du dv) of a sphere map. The map preserves areas: 4 pi over the disc's area pi / 4.
inline constexpr double k_sphere_map_jacobian = 16;

/// The two halves of a dual paraboloid map, each a disc in a square picture of its own.
enum class ParaboloidHalf { front, back };
struct ParaboloidPoint {
    ParaboloidHalf half = ParaboloidHalf::front;
    UV uv;
};

/// The point of a half for a direction: front xy / (1 + z), back xy / (1 - z). It lies within the disc where z has the
/// half's sign. The picture continues outside the disc (to infinity at the opposite pole), so a linear lookup meets no
/// seam. `d` need not be of unit length. (Heidrich and Seidel 1998.)
inline UV paraboloid_uv(ParaboloidHalf half, const Vec3d& d) {
    const double depth = length(d) + (half == ParaboloidHalf::front ? d.z : -d.z);
    return disc_uv({d.x / depth, d.y / depth});
}
/// The half that holds a direction, +Z the front (z = 0 too), and the point.
inline ParaboloidPoint dual_paraboloid_point(const Vec3d& d) {
    const ParaboloidHalf half = d.z < 0 ? ParaboloidHalf::back : ParaboloidHalf::front;
    return {half, paraboloid_uv(half, d)};
}
/// Inverse of paraboloid_uv for any point: (2 p, +-(1 - |p|^2)) / (1 + |p|^2), of unit length.
inline Vec3d paraboloid_direction(ParaboloidHalf half, UV uv) {
    const DiscPoint p = disc_point(uv);
    const double s = p.squared(), z = (1 - s) / (1 + s);
    return {2 * p.x / (1 + s), 2 * p.y / (1 + s), half == ParaboloidHalf::front ? z : -z};
}
/// dω / (du dv) of either half: 16 / (1 + |p|^2)^2, from 16 in the middle to 4 at the rim.
inline double paraboloid_jacobian(UV uv) {
    const double s = 1 + disc_point(uv).squared();
    return 16 / (s * s);
}

}  // namespace domelight
