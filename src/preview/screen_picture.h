#pragma once

#include "domelight/image/image.h"

#include "preview/tonemap.h"

#include <cstdint>

namespace domelight {

/// The exposure of one picture in stops, as exposure_meter.h finds it. `weights` may also be solid angles.
double automatic_ev(ImageView<const float> rgb, ImageView<const float> weights = {}, bool premultiplied = false);

/// The picture as a display shows it, 8-bit sRGB.
///
/// rgb      3 channels, linear radiance
/// opacity  1 channel that `rgb` has been multiplied with, or empty. With it the result has 4 channels, whose colours
///          are not multiplied with the opacity, as PNG wants them.
Image<std::uint8_t> screen_picture(ImageView<const float> rgb, ImageView<const float> opacity, const Display& display,
                                   int threads = 0);

}  // namespace domelight
