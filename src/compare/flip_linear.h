#pragma once

#include "domelight/base/vec.h"
#include "domelight/compare/metrics.h"

namespace domelight {

/// FLIP of two images in linear sRGB, [0, 1].
ImageF flip_linear(ImageView<const float> test, ImageView<const float> reference, const FlipOptions& options,
                   int threads);

}  // namespace domelight
