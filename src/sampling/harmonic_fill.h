#pragma once

#include "domelight/image/image.h"

#include "sampling/texel_sphere.h"

#include <cstdint>
#include <span>

namespace domelight {

/// Continues an image across a region: each channel of the region's texels becomes the solution of Laplace's equation
/// on the sphere whose values on the rim (the texels beside the region) are the image's own. It is the smoothest
/// continuation, and nowhere beyond the rim's least and largest values.
///
// clang-format off
/// region  texels, each once, connected or not
/// image   3 channels, as large as the sphere; read on the rim, written in the region. A part without a rim keeps its
///         values
// clang-format on
void harmonic_fill(const TexelSphere& sphere, std::span<const std::int64_t> region, ImageView<float> image);

}  // namespace domelight
