#pragma once

#include "domelight/scene/scene.h"

#include <array>

namespace domelight {

struct Rgba {
    Vec3f rgb{1, 1, 1};
    float a = 1;
};

/// A texture's value at texture coordinates, bilinear unless the texture asks for the nearest texel; {1, 1, 1, 1}
/// without an image. `srgb`: the colour is decoded before it is filtered (glTF 2.0, 3.9.2).
Rgba look_up(const Scene& scene, const SceneTexture& texture, const Mesh::TexCoord& uv, bool srgb);

}  // namespace domelight
