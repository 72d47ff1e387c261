#pragma once

#include "image/font_glyphs.h"

#include <cstdint>
#include <string_view>

namespace domelight {

/// Sizes of the built-in font: 15 px, and 24 px bold.
enum class FontSize { small, large };

/// The glyph of a code point; a question mark's where the font has none.
const font_data::Glyph& font_glyph(FontSize size, std::uint32_t code);
int font_ascent(FontSize size);   ///< pixels from the baseline up to the top of capitals and accents
int font_descent(FontSize size);  ///< pixels from the baseline down

/// Removes the next code point from UTF-8 `text`, which is not empty. A byte that does not begin a character, by
/// first_utf8_character(), is removed alone and gives U+FFFD, which both fonts draw as a box on its corner.
std::uint32_t next_code_point(std::string_view& text);

/// A glyph of "+-XYZ" at any size: signed distance to its outline in em, positive inside, at (x right of the pen, y
/// above the baseline) in em. For any other `code`, or far outside the glyph, a large negative number.
float font_field(char code, float x, float y);
/// Advance of such a glyph in em, 0 where there is none.
float font_field_advance(char code);

}  // namespace domelight
