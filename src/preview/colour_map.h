#pragma once

#include "image/draw.h"

namespace domelight {

/// A colour for a size: 0 is nearly black, 1 nearly white, by way of violet, red and orange; out of range is clamped,
/// NaN is 0. Lightness (OKLab's; Ottosson 2020) rises evenly, so that equal steps look equal and a grey print keeps the
/// order.
Colour8 heat_colour(float t);

/// A colour for a signed number: -1 blue, 0 near white, +1 red, lightness falling evenly to both sides; clamped.
Colour8 signed_colour(float t);

}  // namespace domelight
