#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"

namespace domelight {

/// An error unless the image has texels of three channels that are all finite and not negative; it names the first
/// texel, by rows, that is not. `threads`: 0 takes all.
Result<void> check_radiance(ImageView<const float> image, int threads);

}  // namespace domelight
