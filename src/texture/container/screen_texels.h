#pragma once
// Texels of eight bits a channel, as in old textures: pictures for a screen, or RGBM and similar encodings without a
// mark.

#include "domelight/io/decode.h"
#include "domelight/texture/texture.h"

#include <array>
#include <cstdint>

namespace domelight {

/// Their layout in a file.
struct ScreenTexels {
    enum class Kind { bytes, bc1, bc2, bc3, bc7 };
    Kind kind = Kind::bytes;
    int bytes = 4;                              ///< of a texel, where kind is bytes
    std::array<int, 4> channel = {0, 1, 2, 3};  ///< which byte is red, green, blue and alpha; -1: there is none
};

/// Texels of eight bits a channel whose format states their curve.
struct StatedScreenTexels {
    ScreenTexels texels;
    bool srgb = false;  ///< the sRGB curve; false: the numbers are proportional to light
};

/// Bytes of a row of texels, or of blocks, in an image `width` texels wide, without padding.
std::uint64_t screen_row_bytes(const ScreenTexels& texels, int width);
/// Rows of texels, or of blocks, in an image `height` texels high.
std::uint64_t screen_rows(const ScreenTexels& texels, int height);

/// What their texels become: half floats; rgbm, rgbd and rgbp are kept as they are.
Encoding screen_encoding(Decode decode);

/// One image of a level: `stored` holds its rows of texels, or of blocks, to width x height texels of
/// screen_encoding(decode) at `out`.
void decode_screen_texels(const ScreenTexels& texels, Decode decode, const std::uint8_t* stored, int width, int height,
                          std::uint8_t* out);

}  // namespace domelight
