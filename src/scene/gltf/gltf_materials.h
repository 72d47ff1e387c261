#pragma once

#include "io/file/json_fields.h"
#include "scene/gltf/gltf_document.h"

#include <vector>

namespace domelight {

/// The file's textures: which image, and how it is sampled. A texture whose image has an unsupported format has none.
std::vector<SceneTexture> read_gltf_textures(JsonFields& root, std::size_t images, std::vector<std::string>& warnings);

/// One material with every extension that Material has fields for. Factors are clamped to their ranges.
Material read_gltf_material(JsonFields fields, const std::vector<SceneTexture>& textures,
                            std::vector<std::string>& warnings);

}  // namespace domelight
