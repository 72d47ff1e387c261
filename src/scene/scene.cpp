#include "domelight/scene/scene.h"

#include "scene/sound_places.h"

#include <algorithm>
#include <optional>

namespace domelight {

Scene::Box Scene::bounds() const {
    std::vector<std::optional<Box>> local(meshes.size());
    std::optional<Box> all;
    for (const Instance& instance : instances) {
        const Mesh& mesh = meshes[std::size_t(instance.mesh)];
        if (mesh.positions.empty()) continue;
        std::optional<Box>& box = local[std::size_t(instance.mesh)];
        if (!box) box = box_of(mesh, {});
        // The vertices need a look only where the box of their box sticks out: a mesh may stand here very often.
        const Box outer = placed(*box, instance.to_world);
        if (all && all->low == united(*all, outer).low && all->high == united(*all, outer).high) continue;
        const Box own = box_of(mesh, instance.to_world);
        all = all ? united(*all, own) : own;
    }
    return all.value_or(Box{});
}

std::int64_t Scene::triangle_count() const {
    std::int64_t count = 0;
    for (const Instance& instance : instances) count += meshes[std::size_t(instance.mesh)].triangle_count();
    return count;
}

}  // namespace domelight
