#pragma once

#include "domelight/scene/scene.h"

#include "cli/console/console.h"

#include <optional>
#include <string>

namespace domelight::cli {

/// Whether the name is that of a built-in scene, or has the ending of a file of triangles: .glb, .gltf, .obj or .ply.
bool may_be_scene(const std::string& name);

/// Describes a scene: its triangles, objects, materials, size, cameras and lights, and what a render would leave out.
/// The exit code.
int info_scene(const std::string& name, const Scene& scene, const CommonOptions& options);

}  // namespace domelight::cli
