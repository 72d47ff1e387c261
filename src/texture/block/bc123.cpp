#include "texture/block/bc123.h"

#include <cstddef>

namespace domelight {

namespace {

using Colour = std::array<std::uint8_t, 4>;

int number(const std::uint8_t* bytes, int count) {
    int value = 0;
    for (int i = 0; i < count; ++i) value |= bytes[i] << 8 * i;
    return value;
}

/// 5, 6 and 5 bits to 8, their upper bits repeated below.
Colour from_565(int c) {
    const int r = c >> 11 & 31, g = c >> 5 & 63, b = c & 31;
    return {std::uint8_t(r << 3 | r >> 2), std::uint8_t(g << 2 | g >> 4), std::uint8_t(b << 3 | b >> 2), 255};
}

Colour mix(const Colour& a, const Colour& b, int share_a, int share_b) {
    const int sum = share_a + share_b;
    Colour out;
    for (std::size_t c = 0; c < 4; ++c) out[c] = std::uint8_t((a[c] * share_a + b[c] * share_b + sum / 2) / sum);
    return out;
}

/// Two ends and two colours between; where BC1's first end is not the larger number, one between and black.
Rgba8Block decode_colours(const std::uint8_t* block, bool may_be_three) {
    const int first = number(block, 2), second = number(block + 2, 2);
    const Colour a = from_565(first), b = from_565(second);
    const bool three = may_be_three && first <= second;
    const Colour palette[4] = {a, b, three ? mix(a, b, 1, 1) : mix(a, b, 2, 1),
                               three ? Colour{0, 0, 0, 0} : mix(a, b, 1, 2)};
    Rgba8Block texels;
    for (std::size_t i = 0; i < 16; ++i) texels[i] = palette[block[4 + i / 4] >> 2 * (i % 4) & 3];
    return texels;
}

}  // namespace

Rgba8Block decode_bc1(const std::uint8_t* block) {
    return decode_colours(block, true);
}

Rgba8Block decode_bc2(const std::uint8_t* block) {
    Rgba8Block texels = decode_colours(block + 8, false);
    for (std::size_t i = 0; i < 16; ++i) texels[i][3] = std::uint8_t((block[i / 2] >> 4 * (i % 2) & 15) * 17);
    return texels;
}

Rgba8Block decode_bc3(const std::uint8_t* block) {
    Rgba8Block texels = decode_colours(block + 8, false);
    const int a = block[0], b = block[1], between = a > b ? 7 : 5;
    std::uint64_t indices = 0;
    for (int i = 0; i < 6; ++i) indices |= std::uint64_t(block[2 + i]) << 8 * i;
    for (std::size_t i = 0; i < 16; ++i, indices >>= 3) {
        const int index = int(indices & 7);
        texels[i][3] =
            std::uint8_t(index == 0                   ? a
                         : index == 1                 ? b
                         : between == 5 && index == 6 ? 0
                         : between == 5 && index == 7 ? 255
                                                      : (a * (between + 1 - index) + b * (index - 1)) / between);
    }
    return texels;
}

}  // namespace domelight
