#pragma once

#include "domelight/vec.h"

#include <numbers>

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

}  // namespace domelight
