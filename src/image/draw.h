#pragma once

#include "domelight/image/image.h"

#include "image/font.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace domelight {

/// 8-bit sRGB.
struct Colour8 {
    std::uint8_t r = 0, g = 0, b = 0;
};

struct Rect {
    int x = 0, y = 0, width = 0, height = 0;
};

/// All functions draw on 3-channel images and ignore pixels outside them.

void fill(ImageView<std::uint8_t> image, Rect where, Colour8 colour);
/// The one-pixel line around the inside of a rectangle.
void frame(ImageView<std::uint8_t> image, Rect where, Colour8 colour);
/// Mixes `colour` into one pixel; `opacity` 0..1.
void blend(ImageView<std::uint8_t> image, int x, int y, Colour8 colour, float opacity);

enum class Align { left, centre, right };

/// Writes UTF-8 text with its baseline at row `baseline`; x is where it starts, its middle, or where it ends.
void draw_text(ImageView<std::uint8_t> image, int x, int baseline, std::string_view text, FontSize size, Colour8 colour,
               Align align = Align::left);
int text_width(std::string_view text, FontSize size);
/// The text if it is at most `width` pixels wide, else its start and its end around an ellipsis.
std::string fit_text(std::string_view text, FontSize size, int width);

}  // namespace domelight
