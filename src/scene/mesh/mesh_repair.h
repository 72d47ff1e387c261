#pragma once

#include "domelight/scene/scene.h"

#include "scene/sound_places.h"

#include <cstdint>
#include <string>
#include <vector>

namespace domelight {

/// What was mended in the meshes of a scene, for its warnings: one line a kind, however many meshes had it.
class MeshRepairs {
  public:
    /// Leaves out triangles that touch a vertex which is not finite (or beyond k_largest_coordinate) and those without
    /// an area; brings normals to length 1 and recomputes, from the triangles around them, those that have none; drops
    /// tangents that are not finite or have no length, and colours and texture coordinates that are not finite become
    /// 0. Precondition: every index is below positions.size(), and arrays are empty or as long as `positions`.
    void mend(Mesh& mesh);
    /// One sentence for each kind of repair.
    std::vector<std::string> warnings() const;

  private:
    struct Kind {
        std::int64_t count = 0;
        std::string first;  // the first mesh that had it
    };
    static void note(Kind& kind, std::int64_t count, const std::string& name);
    void drop_triangles(Mesh& mesh);
    void mend_normals(Mesh& mesh);
    void mend_attributes(Mesh& mesh);

    Kind broken_, flat_, normals_, tangents_, attributes_;
};

/// Gives every vertex the mean direction of the triangles around it, by area; one without any points up.
void smooth_normals(Mesh& mesh);

}  // namespace domelight
