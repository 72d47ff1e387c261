#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"
#include "domelight/render/render.h"
#include "domelight/scene/scene.h"

#include <filesystem>

namespace domelight {

/// A render as an OpenEXR file with all its layers, and the names of the objects in the attribute "objects".
///
/// radiance   the picture itself: the result's, or that over a background colour
Result<void> write_render_layers(const std::filesystem::path& file, const RenderResult& result,
                                 ImageView<const float> radiance, const Scene& scene);

}  // namespace domelight
