#include "scene/sound_places.h"

#include <algorithm>
#include <cmath>

namespace domelight {

bool is_sound(const Vec3f& p) {
    // False for NaN too.
    return std::abs(p.x) < k_largest_coordinate && std::abs(p.y) < k_largest_coordinate &&
           std::abs(p.z) < k_largest_coordinate;
}

bool is_sound(const Affine& a) {
    return is_sound(a.x) && is_sound(a.y) && is_sound(a.z) && is_sound(a.translation);
}

bool has_sound_inverse(const Affine& to_world) {
    constexpr double k_most = 1e6;  // of the inverse's entries
    const Vec3d x(to_world.x), y(to_world.y), z(to_world.z);
    const double determinant = dot(cross(x, y), z);
    if (determinant == 0) return false;
    // The rows of the inverse are these, divided by the determinant.
    for (const Vec3d& row : {cross(y, z), cross(z, x), cross(x, y)})
        if (!(length(row) <= k_most * std::abs(determinant))) return false;
    return true;
}

Scene::Box united(const Scene::Box& a, const Scene::Box& b) {
    return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
            {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

Scene::Box box_of(const Mesh& mesh, const Affine& to_world) {
    const Vec3f first = to_world.point(mesh.positions[0]);
    Scene::Box box{first, first};
    for (const Vec3f& local : mesh.positions) {
        const Vec3f p = to_world.point(local);
        box = united(box, {p, p});
    }
    return box;
}

Scene::Box placed(const Scene::Box& box, const Affine& to_world) {
    Mesh corners;
    for (int i = 0; i < 8; ++i)
        corners.positions.push_back(
            {i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y, i & 4 ? box.high.z : box.low.z});
    return box_of(corners, to_world);
}

}  // namespace domelight
