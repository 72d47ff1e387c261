#include "texture/container/screen_texels.h"

#include "io/picture/screen_colour.h"
#include "texture/block/bc123.h"
#include "texture/block/bc7.h"
#include "texture/texel/half.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace domelight {

namespace {

using Rgba = std::array<std::uint8_t, 4>;

int block_bytes(const ScreenTexels& texels) {
    return texels.kind == ScreenTexels::Kind::bc1 ? 8 : 16;
}

Rgba8Block decode_block(ScreenTexels::Kind kind, const std::uint8_t* block) {
    return kind == ScreenTexels::Kind::bc1   ? decode_bc1(block)
           : kind == ScreenTexels::Kind::bc2 ? decode_bc2(block)
           : kind == ScreenTexels::Kind::bc3 ? decode_bc3(block)
                                             : decode_bc7(block);
}

/// Calls `use(x, y, texel)` for every texel of an image.
template <typename Use>
void for_texels(const ScreenTexels& texels, const std::uint8_t* stored, int width, int height, Use use) {
    if (texels.kind == ScreenTexels::Kind::bytes) {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x, stored += texels.bytes) {
                Rgba texel;
                for (std::size_t c = 0; c < 4; ++c) texel[c] = texels.channel[c] < 0 ? 255 : stored[texels.channel[c]];
                use(x, y, texel);
            }
        return;
    }
    for (int top = 0; top < height; top += 4)
        for (int left = 0; left < width; left += 4, stored += block_bytes(texels)) {
            const Rgba8Block block = decode_block(texels.kind, stored);
            for (int y = top; y < std::min(top + 4, height); ++y)
                for (int x = left; x < std::min(left + 4, width); ++x)
                    use(x, y, block[std::size_t((y - top) * 4 + x - left)]);
        }
}

}  // namespace

std::uint64_t screen_row_bytes(const ScreenTexels& texels, int width) {
    const auto texels_wide = std::uint64_t(width);
    if (texels.kind == ScreenTexels::Kind::bytes) return texels_wide * std::uint64_t(texels.bytes);
    return (texels_wide + 3) / 4 * std::uint64_t(block_bytes(texels));
}

std::uint64_t screen_rows(const ScreenTexels& texels, int height) {
    return texels.kind == ScreenTexels::Kind::bytes ? std::uint64_t(height) : (std::uint64_t(height) + 3) / 4;
}

Encoding screen_encoding(Decode decode) {
    return decode == Decode::rgbm   ? Encoding::rgbm
           : decode == Decode::rgbd ? Encoding::rgbd
           : decode == Decode::rgbp ? Encoding::rgbp
                                    : Encoding::rgba16f;
}

void decode_screen_texels(const ScreenTexels& texels, Decode decode, const std::uint8_t* stored, int width, int height,
                          std::uint8_t* out) {
    if (screen_encoding(decode) != Encoding::rgba16f) {
        for_texels(texels, stored, width, height, [&](int x, int y, const Rgba& texel) {
            std::memcpy(out + 4 * (std::size_t(y) * std::size_t(width) + std::size_t(x)), texel.data(), 4);
        });
        return;
    }
    std::vector<std::uint16_t> half;
    for (const float v : screen_curve(decode, 256)) half.push_back(half_from_float(v));
    for_texels(texels, stored, width, height, [&](int x, int y, const Rgba& texel) {
        const std::uint16_t values[4] = {half[texel[0]], half[texel[1]], half[texel[2]],
                                         half_from_float(float(texel[3]) / 255)};
        std::memcpy(out + 8 * (std::size_t(y) * std::size_t(width) + std::size_t(x)), values, 8);
    });
}

}  // namespace domelight
