#pragma once

#include "domelight/scene/scene.h"

#include "scene/scene_images.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace domelight {

/// Adds the materials of a Wavefront .mtl to a scene. Their Phong terms are converted to metallic-roughness by a rule
/// of thumb, as in other tools: F0 = 0.08 Ks and GGX alpha = sqrt(2 / (Ns + 2)), which gives the two lobes the same
/// curvature at their peak (Walter et al. 2007, section 5.2). `numbers`: material by name. `sources`: their images, to
/// be opened in `folder` and nowhere outside `root`.
void read_mtl(std::string_view text, const std::filesystem::path& folder, const std::filesystem::path& root,
              Scene& scene, std::map<std::string, int, std::less<>>& numbers, std::vector<SceneImageSource>& sources);

/// The default surface: light grey, of roughness 0.5, visible from both sides.
Material plain_material();

}  // namespace domelight
