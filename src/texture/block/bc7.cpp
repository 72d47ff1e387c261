#include "texture/block/bc7.h"

#include <bit>
#include <cstddef>
#include <utility>

namespace domelight {

namespace {

/// What a mode's block consists of: numbers of subsets of texels and of bits.
struct Mode {
    int subsets, partition, rotation, selection;
    int colour, alpha;        ///< bits of a channel of an endpoint; alpha 0: it is opaque
    int own_low, shared_low;  ///< 1: an endpoint, or both of a subset, have a lowest bit that all channels share
    int index, second_index;  ///< bits of a texel's index; second_index 0: there is one for all channels
};
constexpr Mode k_mode[8] = {
    {3, 4, 0, 0, 4, 0, 1, 0, 3, 0}, {2, 6, 0, 0, 6, 0, 0, 1, 3, 0}, {3, 6, 0, 0, 5, 0, 0, 0, 2, 0},
    {2, 6, 0, 0, 7, 0, 1, 0, 2, 0}, {1, 0, 2, 1, 5, 6, 0, 0, 2, 3}, {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
    {1, 0, 0, 0, 7, 7, 1, 0, 4, 0}, {2, 6, 0, 0, 5, 5, 1, 0, 2, 0},
};

/// The subset of each texel, of two: a bit each, the first texel lowest.
constexpr std::uint16_t k_two[64] = {
    0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80, 0xe800, 0xffe8,
    0xff00, 0xfff0, 0xf000, 0xf710, 0x008e, 0x7100, 0x08ce, 0x008c, 0x7310, 0x3100, 0x8cce, 0x088c, 0x3110,
    0x6666, 0x366c, 0x17e8, 0x0ff0, 0x718e, 0x399c, 0xaaaa, 0xf0f0, 0x5a5a, 0x33cc, 0x3c3c, 0x55aa, 0x9696,
    0xa55a, 0x73ce, 0x13c8, 0x324c, 0x3bdc, 0x6996, 0xc33c, 0x9966, 0x0660, 0x0272, 0x04e4, 0x4e40, 0x2720,
    0xc936, 0x936c, 0x39c6, 0x639c, 0x9336, 0x9cc6, 0x817e, 0xe718, 0xccf0, 0x0fcc, 0x7744, 0xee22,
};
/// Of three: two bits each.
constexpr std::uint32_t k_three[64] = {
    0xaa685050, 0x6a5a5040, 0x5a5a4200, 0x5450a0a8, 0xa5a50000, 0xa0a05050, 0x5555a0a0, 0x5a5a5050,
    0xaa550000, 0xaa555500, 0xaaaa5500, 0x90909090, 0x94949494, 0xa4a4a4a4, 0xa9a59450, 0x2a0a4250,
    0xa5945040, 0x0a425054, 0xa5a5a500, 0x55a0a0a0, 0xa8a85454, 0x6a6a4040, 0xa4a45000, 0x1a1a0500,
    0x0050a4a4, 0xaaa59090, 0x14696914, 0x69691400, 0xa08585a0, 0xaa821414, 0x50a4a450, 0x6a5a0200,
    0xa9a58000, 0x5090a0a8, 0xa8a09050, 0x24242424, 0x00aa5500, 0x24924924, 0x24499224, 0x50a50a50,
    0x500aa550, 0xaaaa4444, 0x66660000, 0xa5a0a5a0, 0x50a050a0, 0x69286928, 0x44aaaa44, 0x66666600,
    0xaa444444, 0x54a854a8, 0x95809580, 0x96969600, 0xa85454a8, 0x80959580, 0xaa141414, 0x96960000,
    0xaaaa1414, 0xa05050a0, 0xa0a5a5a0, 0x96000000, 0x40804080, 0xa9a8a9a8, 0xaaaaaa44, 0x2a4a5254,
};
/// The texel of each further subset whose index lacks its highest bit, which is 0: of the second of two, and of the second
/// and the third of three. Of the first subset it is texel 0.
constexpr std::uint8_t k_anchor_two[64] = {
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2,  8, 2,  2, 8,
    8,  15, 2,  8,  2,  2,  8,  8,  2,  2,  15, 15, 6,  8,  2,  8,  15, 15, 2, 8,  2, 2,
    2,  15, 15, 6,  6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2, 15,
};
constexpr std::uint8_t k_anchor_second[64] = {
    3, 3,  15, 15, 8, 3,  15, 15, 8,  8, 6,  6, 6,  5,  3,  3,  3, 3,  8, 15, 3, 3, 6, 10, 5, 8,  8, 6,  8,  5,  15, 15,
    8, 15, 3,  5,  6, 10, 8,  15, 15, 3, 15, 5, 15, 15, 15, 15, 3, 15, 5, 5,  5, 8, 5, 10, 5, 10, 8, 13, 15, 12, 3,  3,
};
constexpr std::uint8_t k_anchor_third[64] = {
    15, 8, 8, 3,  15, 15, 3,  8,  15, 15, 15, 15, 15, 15, 15, 8,  15, 8,  15, 3,  15, 8,
    15, 8, 3, 15, 6,  10, 15, 15, 10, 8,  15, 3,  15, 10, 10, 8,  9,  10, 6,  15, 8,  15,
    3,  6, 6, 8,  15, 3,  15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 3,  15, 15, 8,
};

/// The share of the second endpoint, of 64, by the bits of an index.
constexpr int k_weight_two[4] = {0, 21, 43, 64}, k_weight_three[8] = {0, 9, 18, 27, 37, 46, 55, 64},
              k_weight_four[16] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};

int weight(int bits, int index) {
    return bits == 2 ? k_weight_two[index] : bits == 3 ? k_weight_three[index] : k_weight_four[index];
}

/// The bits of a block, the lowest first.
class Bits {
  public:
    explicit Bits(const std::uint8_t* block) : block_(block) {}
    int take(int count) {
        int value = 0;
        for (int i = 0; i < count; ++i, ++at_) value |= (block_[at_ / 8] >> at_ % 8 & 1) << i;
        return value;
    }

  private:
    const std::uint8_t* block_;
    int at_ = 0;
};

int subset_of(int subsets, int partition, int texel) {
    if (subsets == 1) return 0;
    return subsets == 2 ? k_two[partition] >> texel & 1 : int(k_three[partition] >> 2 * texel & 3);
}

bool is_anchor(int subsets, int partition, int texel) {
    if (texel == 0 || subsets == 1) return texel == 0;
    if (subsets == 2) return texel == k_anchor_two[partition];
    return texel == k_anchor_second[partition] || texel == k_anchor_third[partition];
}

/// `bits` bits as eight, the upper ones repeated below.
int widened(int value, int bits) {
    value <<= 8 - bits;
    return value | value >> bits;
}

using Endpoints = std::array<std::array<int, 4>, 6>;

/// Both endpoints of each subset, one subset after the other.
Endpoints read_endpoints(Bits& bits, const Mode& mode) {
    Endpoints ends{};
    const auto count = std::size_t(2 * mode.subsets);
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t e = 0; e < count; ++e) ends[e][c] = bits.take(c < 3 ? mode.colour : mode.alpha);
    const int low = mode.own_low + mode.shared_low;
    for (std::size_t e = 0, bit = 0; low && e < count; ++e) {
        if (mode.own_low || e % 2 == 0) bit = std::size_t(bits.take(1));
        for (int& v : ends[e]) v = v << 1 | int(bit);
    }
    for (std::size_t e = 0; e < count; ++e)
        for (std::size_t c = 0; c < 4; ++c)
            ends[e][c] =
                c == 3 && mode.alpha == 0 ? 255 : widened(ends[e][c], (c < 3 ? mode.colour : mode.alpha) + low);
    return ends;
}

}  // namespace

Rgba8Block decode_bc7(const std::uint8_t* block) {
    Rgba8Block texels{};
    const int number = std::countr_zero(block[0]);
    if (number > 7) return texels;
    const Mode& mode = k_mode[number];
    Bits bits(block);
    bits.take(number + 1);
    const int partition = bits.take(mode.partition), rotation = bits.take(mode.rotation);
    const bool swapped = bits.take(mode.selection) == 1;  // the second indices are those of the colour
    const Endpoints ends = read_endpoints(bits, mode);
    int first[16], second[16];
    for (int i = 0; i < 16; ++i) first[i] = bits.take(mode.index - is_anchor(mode.subsets, partition, i));
    for (int i = 0; i < 16; ++i) second[i] = mode.second_index ? bits.take(mode.second_index - (i == 0)) : first[i];
    const int second_bits = mode.second_index ? mode.second_index : mode.index;
    for (int i = 0; i < 16; ++i) {
        const auto from = std::size_t(2 * subset_of(mode.subsets, partition, i));
        const int one = weight(mode.index, first[i]), two = weight(second_bits, second[i]);
        auto& texel = texels[std::size_t(i)];
        for (std::size_t c = 0; c < 4; ++c) {
            const int w = (c < 3) == swapped ? two : one;
            texel[c] = std::uint8_t((ends[from][c] * (64 - w) + ends[from + 1][c] * w + 32) >> 6);
        }
        if (rotation) std::swap(texel[3], texel[std::size_t(rotation - 1)]);
    }
    return texels;
}

}  // namespace domelight
