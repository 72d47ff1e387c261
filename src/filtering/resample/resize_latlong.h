#pragma once

#include "domelight/image/image.h"

namespace domelight {

/// A lat-long image at another size, which need not be twice as wide as high: each texel the mean over its own solid
/// angle of the texels it covers, weighted by sin(theta) d theta. Power is kept; a constant stays constant. Intended
/// for reducing images.
ImageF resize_latlong(ImageView<const float> source, int width, int height);

}  // namespace domelight
