#pragma once

#include "domelight/image/image.h"

#include <string>
#include <vector>

namespace domelight {

/// A cube as one picture: "cross" (4 x 3 faces: +Y above, -X +Z +X -Z, -Y below), "vertical-cross" (3 x 4, -Z upside
/// down at the bottom), "strip" (6 x 1), "vertical-strip" (1 x 6). Returns an empty image for any other name.
ImageF cube_layout(const Cubemap& cube, const std::string& layout);

/// The names of these layouts.
std::vector<std::string> cube_layout_names();

}  // namespace domelight
