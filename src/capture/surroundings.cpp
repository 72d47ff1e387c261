#include "capture/surroundings.h"

#include "render/ray_scene.h"

namespace domelight {
namespace {

bool is_back(const Scene& scene, const Hit& hit, const Vec3f& direction, Backs backs) {
    if (!(dot(hit.geometric_normal, direction) > 0)) return false;
    const Mesh& mesh = scene.meshes[std::size_t(scene.instances[std::size_t(hit.instance)].mesh)];
    return backs == Backs::all || !scene.materials[std::size_t(mesh.material)].double_sided;
}

}  // namespace

Surroundings look_around(const RayScene& scene, const Vec3f& from, std::span<const Vec3f> directions, Backs which) {
    Surroundings around;
    int backs = 0, surfaces = 0;
    for (const Vec3f& direction : directions) {
        const Hit hit = scene.impl().intersect({from, direction, 0}, false);
        if (hit.instance < 0) continue;
        ++surfaces;
        const bool back = is_back(scene.scene(), hit, direction, which);
        backs += back;
        if (back || hit.distance >= around.front_distance) continue;
        around.front_distance = hit.distance;
        around.to_front = direction;
    }
    around.backs = float(backs) / float(directions.size());
    around.surfaces = float(surfaces) / float(directions.size());
    return around;
}

SurfaceAlong surface_along(const RayScene& scene, const Vec3f& from, const Vec3f& direction) {
    const Hit hit = scene.impl().intersect({from, direction, 0}, false);
    if (hit.instance < 0) return {};
    return {hit.distance, normalize(hit.geometric_normal)};
}

int surfaces_between(const RayScene& scene, const Vec3f& from, const Vec3f& to, int most) {
    const float distance = length(to - from);
    if (!(distance > 0)) return 0;
    Ray ray{from, (to - from) / distance, 0};
    for (int count = 0; count < most; ++count) {
        const Hit hit = scene.impl().intersect(ray, false);
        if (hit.instance < 0 || hit.distance >= distance) return count;
        pass(ray, hit);
    }
    return most;
}

}  // namespace domelight
