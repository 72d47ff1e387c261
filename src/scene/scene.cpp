#include "domelight/scene/scene.h"

#include <algorithm>

namespace domelight {

Scene::Box Scene::bounds() const {
    Box box;
    bool first = true;
    for (const Instance& instance : instances)
        for (const Vec3f& local : meshes[std::size_t(instance.mesh)].positions) {
            const Vec3f p = instance.to_world.point(local);
            box.low = first ? p : Vec3f{std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
            box.high =
                first ? p : Vec3f{std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
            first = false;
        }
    return box;
}

std::int64_t Scene::triangle_count() const {
    std::int64_t count = 0;
    for (const Instance& instance : instances) count += meshes[std::size_t(instance.mesh)].triangle_count();
    return count;
}

}  // namespace domelight
