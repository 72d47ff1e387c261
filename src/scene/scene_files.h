#pragma once

#include "domelight/base/result.h"

#include <filesystem>
#include <vector>

namespace domelight {

/// The files besides its own that load_scene() opens for a scene: buffers and pictures of a glTF file, the .mtl files of
/// an .obj and their pictures. Each once, in the order in which they are named, relative to the scene's folder. Names of
/// files that do not exist or lie elsewhere are left out, because load_scene() tells of them.
/// Errors: the scene's own file cannot be read, or is not JSON where it is glTF.
Result<std::vector<std::filesystem::path>> files_named_by_scene(const std::filesystem::path& scene);

}  // namespace domelight
