#pragma once

#include "scene/gltf/gltf_data.h"
#include "scene/mesh/mesh_repair.h"

#include <vector>

namespace domelight {

/// Where the joints of a skin are: world (or model) from the space of the bind pose.
using GltfPose = std::vector<Affine>;

/// Counts what was left out of the meshes, for the scene's warnings.
struct GltfLeftOut {
    std::int64_t points_and_lines = 0, broken_joints = 0;
};

/// Builds the triangles of one primitive: strips and fans unrolled, morph targets added with `weights` (those that are
/// missing count as 0), vertices moved by `pose` (empty: not skinned), repaired. A primitive of points or lines has no
/// triangles. Errors: indices or accessors out of range, attributes of different lengths, broken compression.
Result<Mesh> build_gltf_mesh(GltfData& data, const GltfPrimitive& primitive, const std::vector<float>& weights,
                             const GltfPose& pose, const std::string& name, ByteBudget& budget, MeshRepairs& repairs,
                             GltfLeftOut& left_out);

}  // namespace domelight
