#pragma once

#include "domelight/scene/scene.h"

#include "io/file/byte_budget.h"
#include "io/file/file_reader.h"
#include "scene/gltf/gltf_uri.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace domelight {

/// An image file of a scene, opened when it is used.
struct SceneImageSource {
    std::string name;
    std::function<Result<std::shared_ptr<const FileBytes>>()> open;
};

/// Every texture of a material.
std::vector<SceneTexture*> textures_of(Material& material);

/// Decodes the sources that the scene's materials use, in parallel, into scene.images (those that nothing uses stay
/// empty there). Where a source is missing, refused, broken or of a foreign format, its textures are taken from the
/// materials, whose factors remain, with a warning. Errors: more memory than the budget has.
Result<void> load_scene_images(const std::vector<SceneImageSource>& sources, Scene& scene, ByteBudget& budget,
                               int threads);

}  // namespace domelight
