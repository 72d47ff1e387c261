#pragma once

#include "domelight/scene/scene.h"

#include <string>

namespace domelight {

/// SHA-256, as 64 hexadecimal digits, of all that determines a scene's light: triangles, places, materials, textures
/// and lights, but neither names nor cameras. A set of probes records it, so that a scene that has changed since the
/// capture is noticed, whichever of its files holds the change.
std::string scene_sha256(const Scene& scene);

}  // namespace domelight
