#pragma once

#include "domelight/scene/scene.h"

#include "io/file/file_reader.h"

#include <memory>

namespace domelight {

/// One by format; `folder` is where other files are looked up. Errors name no file: the caller adds it.
Result<Scene> read_gltf(std::shared_ptr<const FileBytes> bytes, const std::filesystem::path& folder,
                        const SceneOptions& options);
Result<EnvironmentLights> read_gltf_lights(std::shared_ptr<const FileBytes> bytes, const std::filesystem::path& folder,
                                           const SceneOptions& options);
Result<Scene> read_obj(std::shared_ptr<const FileBytes> bytes, const std::filesystem::path& folder,
                       const SceneOptions& options);
Result<Scene> read_ply(std::shared_ptr<const FileBytes> bytes, const SceneOptions& options);

}  // namespace domelight
