#pragma once

#include "image/draw.h"

namespace domelight {

/// Antialiased lines and dots: a pixel is blended by its coverage, which is computed from its distance to the outline.
/// Pixel (i, j) has its centre at (i + 0.5, j + 0.5). Parts outside the image are ignored; coordinates may have any
/// finite value.

/// A line with round ends, `width` pixels wide.
void stroke(ImageView<std::uint8_t> image, double x0, double y0, double x1, double y1, double width, Colour8 colour,
            double opacity = 1);
/// A filled circle.
void disc(ImageView<std::uint8_t> image, double x, double y, double radius, Colour8 colour, double opacity = 1);

}  // namespace domelight
