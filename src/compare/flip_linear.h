#pragma once

#include "domelight/compare/metrics.h"
#include "domelight/base/vec.h"

namespace domelight {

/// FLIP of two images in linear sRGB, [0, 1].
ImageF flip_linear(ImageView<const float> test, ImageView<const float> reference, const FlipOptions& options,
                   int threads);

}  // namespace domelight
