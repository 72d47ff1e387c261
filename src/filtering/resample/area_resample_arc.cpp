#include "filtering/resample/area_resample_arc.h"

#include "domelight/projection/projection.h"

namespace domelight::area {

std::vector<Arc> cube_texel_border(int face, int x, int y, int size, const Mat3& world_to_source) {
    const auto corner = [&](int i, int j) {
        return normalize(world_to_source * cube_direction(face, {double(x + i) / size, double(y + j) / size}));
    };
    const Vec3d a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
    return {great_arc(a, b), great_arc(b, c), great_arc(c, d), great_arc(d, a)};
}

std::vector<Arc> latlong_border(double u0, double u1, double v0, double v1, const Mat3& world_to_source) {
    const auto source = [&](double u, double v) { return world_to_source * latlong_direction({u, v}); };
    const Vec3d axis = world_to_source * Vec3d{0, 1, 0};
    // Along v = const, in the direction of growing (sign > 0) or falling u.
    const auto parallel = [&](double v, double from, double to) {
        const double sine = std::sin(k_pi * v), sign = to > from ? 1 : -1;
        const Vec3d start = source(from, 0.5), ahead = source(from + 0.25 * sign, 0.5);
        return Arc{axis * std::cos(k_pi * v), start * sine, ahead * sine, 0, 2 * k_pi * std::abs(to - from)};
    };
    std::vector<Arc> border;
    if (v0 > 0) border.push_back(parallel(v0, u0, u1));
    border.push_back(great_arc(source(u1, v0), source(u1, v1)));
    if (v1 < 1) border.push_back(parallel(v1, u1, u0));
    border.push_back(great_arc(source(u0, v1), source(u0, v0)));
    return border;
}

}  // namespace domelight::area
