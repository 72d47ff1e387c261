#include "domelight/projection/projection.h"

namespace domelight {

double latlong_solid_angle(int y, int width, int height) {
    // cos a - cos b = 2 sin((a+b)/2) sin((b-a)/2): no cancellation in thin rows.
    return 2 * k_pi / width * 2 * std::sin(k_pi * (y + 0.5) / height) * std::sin(k_pi * 0.5 / height);
}

CubePoint cube_point(const Vec3d& d) {
    const double ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z);
    const auto point = [](int face, double s, double t, double m) {
        return CubePoint{face, {0.5 * (s / m + 1), 0.5 * (t / m + 1)}};
    };
    if (ax >= ay && ax >= az) return d.x > 0 ? point(0, -d.z, -d.y, ax) : point(1, d.z, -d.y, ax);
    if (ay >= az) return d.y > 0 ? point(2, d.x, d.z, ay) : point(3, d.x, -d.z, ay);
    return d.z > 0 ? point(4, d.x, -d.y, az) : point(5, -d.x, -d.y, az);
}

double cube_solid_angle(int x, int y, int size) {
    // Solid angle between the face's centre and the corner (s, t): atan(s t / sqrt(s^2 + t^2 + 1)).
    const auto corner = [](double s, double t) { return std::atan2(s * t, std::sqrt(s * s + t * t + 1)); };
    const double x0 = 2.0 * x / size - 1, x1 = 2.0 * (x + 1) / size - 1, y0 = 2.0 * y / size - 1,
                 y1 = 2.0 * (y + 1) / size - 1;
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
}

}  // namespace domelight
