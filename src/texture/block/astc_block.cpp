#include "texture/block/astc_block.h"

#include "texture/block/astc_ise.h"

#include <algorithm>
#include <cassert>

namespace domelight {

namespace {

/// The position of the endpoint values: after the block mode, the number of subsets, the seed and the endpoint mode.
constexpr int first_endpoint_bit(int subsets) {
    return subsets == 1 ? 17 : 29;
}

/// The block mode of 4 x 4 weights in one plane ("2D block mode layout", first row, A = 2, B = 0): weight ranges are
/// named by three bits R and one H that stands for "high precision".
int block_mode(int weight_range) {
    const int h = weight_range >= 6, r = weight_range - (h ? 6 : 0) + 2;
    return h << 9 | 2 << 5 | (r & 1) << 4 | r >> 1;
}

std::uint32_t hash52(std::uint32_t v) {
    v ^= v >> 15;
    v *= 0xeede0891u;  // (2^4 + 1)(2^7 + 1)(2^17 - 1)
    v ^= v >> 5;
    v += v << 16;
    v ^= v >> 7;
    v ^= v >> 3;
    v ^= v << 6;
    v ^= v >> 17;
    return v;
}

}  // namespace

int astc_endpoint_range(int weight_range, int endpoint_mode, int subsets) {
    const int room = 128 - k_ise_ranges[std::size_t(weight_range)].size(16) - first_endpoint_bit(subsets);
    int range = k_ise_256;
    while (range > 0 && k_ise_ranges[std::size_t(range)].size(subsets * endpoint_values(endpoint_mode)) > room) --range;
    return range;
}

std::uint32_t astc_partition(int seed) {
    // Two subsets, so a seed offset of 1024; only the first two of four planes are compared. Blocks of fewer than 31
    // texels double their coordinates.
    const std::uint32_t s = std::uint32_t(seed) + 1024, random = hash52(s);
    const auto slope = [&](int shift_bits, int shift) {
        const std::uint32_t v = random >> shift_bits & 15;
        return int(v * v >> shift);
    };
    const int even = s & 2 ? 4 : 5, shift1 = s & 1 ? even : 5, shift2 = s & 1 ? 5 : even;
    const int ax = slope(0, shift1), ay = slope(4, shift2), bx = slope(8, shift1), by = slope(12, shift2);
    std::uint32_t pattern = 0;
    for (int i = 0; i < 16; ++i) {
        const int x = 2 * (i & 3), y = 2 * (i >> 2);
        const int a = int((std::uint32_t(ax * x + ay * y) + (random >> 14)) & 63),
                  b = int((std::uint32_t(bx * x + by * y) + (random >> 10)) & 63);
        if (a < b) pattern |= 1u << i;
    }
    return pattern;
}

void pack_astc(const AstcBlock& block, std::span<std::uint8_t, 16> out) {
    Bits128 bits;
    if (block.solid) {
        bits.low = 0xfffffffffffffffcu;  // void extent, HDR, no coordinates
        for (int c = 0; c < 3; ++c) bits.put(64 + 16 * c, 16, block.colour[std::size_t(c)]);
        bits.put(112, 16, 0x3c00);
    } else {
        const IseRange& weights = k_ise_ranges[std::size_t(block.weight_range)];
        std::array<std::uint8_t, 16> numbers;
        for (std::size_t i = 0; i < 16; ++i)
            numbers[i] = std::uint8_t(ise_weight_number(block.weight_range, block.weights[i]));
        // Weights run from the block's end towards its front.
        ise_encode(weights, numbers, bits, 0);
        bits = bits.reversed();
        bits.put(0, 11, std::uint32_t(block_mode(block.weight_range)));
        bits.put(11, 2, std::uint32_t(block.subsets - 1));
        if (block.subsets == 1) {
            bits.put(13, 4, std::uint32_t(block.endpoint_mode));
        } else {
            bits.put(13, 10, std::uint32_t(block.seed));
            bits.put(23, 6, std::uint32_t(block.endpoint_mode) << 2);  // low bits 00: the same mode in both
        }
        const int range = astc_endpoint_range(block.weight_range, block.endpoint_mode, block.subsets),
                  count = block.subsets * endpoint_values(block.endpoint_mode);
        std::array<std::uint8_t, 12> colours;
        for (int i = 0; i < count; ++i) {
            colours[std::size_t(i)] = std::uint8_t(ise_colour_number(range, block.values[std::size_t(i)]));
            assert(ise_colour(range, colours[std::size_t(i)]) == block.values[std::size_t(i)]);
        }
        ise_encode(k_ise_ranges[std::size_t(range)], std::span(colours).first(std::size_t(count)), bits,
                   first_endpoint_bit(block.subsets));
    }
    for (std::size_t i = 0; i < 8; ++i) {
        out[i] = std::uint8_t(bits.low >> 8 * i);
        out[8 + i] = std::uint8_t(bits.high >> 8 * i);
    }
}

std::optional<AstcBlock> unpack_astc(std::span<const std::uint8_t, 16> in) {
    Bits128 bits;
    for (std::size_t i = 0; i < 8; ++i) {
        bits.low |= std::uint64_t(in[i]) << 8 * i;
        bits.high |= std::uint64_t(in[8 + i]) << 8 * i;
    }
    AstcBlock block;
    if (bits.get(0, 9) == 0x1fc) {
        // HDR, the reserved bits, and no coordinates, as the format requires.
        if (bits.low != 0xfffffffffffffffcu || bits.get(112, 16) != 0x3c00) return std::nullopt;
        block.solid = true;
        for (int c = 0; c < 3; ++c) {
            block.colour[std::size_t(c)] = std::uint16_t(bits.get(64 + 16 * c, 16));
            if (block.colour[std::size_t(c)] >= 0x7c00) return std::nullopt;  // negative or not a number
        }
        return block;
    }
    const std::uint32_t mode = bits.get(0, 11);
    const int r = int((mode & 3) << 1 | (mode >> 4 & 1)), h = int(mode >> 9 & 1);
    if (r < 2 || (r == 2 && !h)) return std::nullopt;  // two weights take fewer bits than the format requires
    block.weight_range = r - 2 + 6 * h;
    if (mode != std::uint32_t(block_mode(block.weight_range))) return std::nullopt;
    block.subsets = int(bits.get(11, 2)) + 1;
    if (block.subsets > 2) return std::nullopt;
    if (block.subsets == 1) {
        block.endpoint_mode = int(bits.get(13, 4));
    } else {
        block.seed = int(bits.get(13, 10));
        if (bits.get(23, 2) != 0) return std::nullopt;
        block.endpoint_mode = int(bits.get(25, 4));
    }
    if (block.endpoint_mode != k_cem_hdr_rgb && block.endpoint_mode != k_cem_hdr_base_scale) return std::nullopt;
    const int range = astc_endpoint_range(block.weight_range, block.endpoint_mode, block.subsets),
              count = block.subsets * endpoint_values(block.endpoint_mode);
    if (range < 4) return std::nullopt;  // fewer than six levels of colour: a block that is not valid
    std::array<std::uint8_t, 12> colours;
    ise_decode(k_ise_ranges[std::size_t(range)], bits, first_endpoint_bit(block.subsets),
               std::span(colours).first(std::size_t(count)));
    for (int i = 0; i < count; ++i)
        block.values[std::size_t(i)] = std::uint8_t(ise_colour(range, colours[std::size_t(i)]));
    std::array<std::uint8_t, 16> numbers;
    ise_decode(k_ise_ranges[std::size_t(block.weight_range)], bits.reversed(), 0, numbers);
    for (std::size_t i = 0; i < 16; ++i)
        block.weights[i] = std::uint8_t(ise_weight_rank(block.weight_range, numbers[i]));
    return block;
}

namespace {

int sign_extend(int v, int bits) {
    const int top = 1 << (bits - 1);
    return ((v & ((1 << bits) - 1)) ^ top) - top;
}

/// "HDR Endpoint Mode 11": the largest channel of the high colour, and differences from it.
AstcEndpoints endpoints_rgb(const std::uint8_t* v) {
    const int major = v[4] >> 7 | (v[5] >> 7) << 1;
    if (major == 3) return {{v[0] << 4, v[2] << 4, (v[4] & 0x7f) << 5}, {v[1] << 4, v[3] << 4, (v[5] & 0x7f) << 5}};
    const int mode = v[1] >> 7 | (v[2] >> 7) << 1 | (v[3] >> 7) << 2;
    int a = v[0] | (v[1] & 0x40) << 2, b0 = v[2] & 0x3f, b1 = v[3] & 0x3f, c = v[1] & 0x3f;
    const int x0 = v[2] >> 6 & 1, x1 = v[3] >> 6 & 1, x2 = v[4] >> 6 & 1, x3 = v[5] >> 6 & 1, x4 = v[4] >> 5 & 1,
              x5 = v[5] >> 5 & 1;
    static constexpr int k_difference_bits[8] = {7, 6, 7, 6, 5, 6, 5, 6};
    int d0 = sign_extend(v[4] & 0x7f, k_difference_bits[mode]), d1 = sign_extend(v[5] & 0x7f, k_difference_bits[mode]);
    // The upper bits of the fields lie in x0 .. x5, differently in each mode.
    const int here = 1 << mode;
    if (here & 0xa4) a |= x0 << 9;
    if (here & 0x08) a |= x2 << 9;
    if (here & 0x50) a |= x4 << 9 | x5 << 10;
    if (here & 0xa0) a |= x1 << 10;
    if (here & 0xc0) a |= x2 << 11;
    if (here & 0x04) c |= x1 << 6;
    if (here & 0xe8) c |= x3 << 6;
    if (here & 0x20) c |= x2 << 7;
    if (here & 0x5b) b0 |= x0 << 6, b1 |= x1 << 6;
    if (here & 0x12) b0 |= x2 << 7, b1 |= x3 << 7;
    const int unit = 1 << (3 - mode / 2);
    a *= unit, b0 *= unit, b1 *= unit, c *= unit, d0 *= unit, d1 *= unit;
    AstcEndpoints e{{a - c, a - b0 - c - d0, a - b1 - c - d1}, {a, a - b0, a - b1}};
    for (auto* colour : {&e.low, &e.high}) {
        for (int& channel : *colour) channel = std::clamp(channel, 0, 4095);
        std::swap((*colour)[0], (*colour)[std::size_t(major)]);
    }
    return e;
}

/// "HDR Endpoint Mode 7": a colour by its largest channel and differences from it, and how far the low one lies below
/// it in every channel.
AstcEndpoints endpoints_base_scale(const std::uint8_t* v) {
    const int bits = v[0] >> 6 | (v[1] >> 7) << 2 | (v[2] >> 7) << 3;
    const int major = (bits & 12) != 12 ? bits >> 2
                      : bits != 15      ? bits & 3
                                        : 0,
              mode = (bits & 12) != 12 ? bits & 3
                     : bits != 15      ? 4
                                       : 5;
    int red = v[0] & 0x3f, green = v[1] & 0x1f, blue = v[2] & 0x1f, scale = v[3] & 0x1f;
    const int x0 = v[1] >> 6 & 1, x1 = v[1] >> 5 & 1, x2 = v[2] >> 6 & 1, x3 = v[2] >> 5 & 1, x4 = v[3] >> 7,
              x5 = v[3] >> 6 & 1, x6 = v[3] >> 5 & 1;
    const int here = 1 << mode;
    if (here & 0x30) green |= x0 << 6, blue |= x2 << 6;
    if (here & 0x3a) green |= x1 << 5, blue |= x3 << 5;
    if (here & 0x3d) scale |= x6 << 5;
    if (here & 0x2d) scale |= x5 << 6;
    if (here & 0x04) scale |= x4 << 7;
    if (here & 0x3b) red |= x4 << 6;
    if (here & 0x04) red |= x3 << 6;
    if (here & 0x10) red |= x5 << 7;
    if (here & 0x0f) red |= x2 << 7;
    if (here & 0x05) red |= x1 << 8 | x0 << 9;
    if (here & 0x0a) red |= x0 << 8;
    if (here & 0x02) red |= x6 << 9 | x5 << 10;
    if (here & 0x01) red |= x3 << 10;
    static constexpr int k_shift[6] = {1, 1, 2, 3, 4, 5};
    red <<= k_shift[mode], green <<= k_shift[mode], blue <<= k_shift[mode], scale <<= k_shift[mode];
    if (mode != 5) green = red - green, blue = red - blue;
    AstcEndpoints e{{red - scale, green - scale, blue - scale}, {red, green, blue}};
    for (auto* colour : {&e.low, &e.high}) {
        for (int& channel : *colour) channel = std::clamp(channel, 0, 4095);
        std::swap((*colour)[0], (*colour)[std::size_t(major)]);
    }
    return e;
}

}  // namespace

AstcEndpoints astc_endpoints(int endpoint_mode, const std::uint8_t* values) {
    return endpoint_mode == k_cem_hdr_rgb ? endpoints_rgb(values) : endpoints_base_scale(values);
}

std::uint16_t half_from_astc(int value) {
    // The mantissa of a half is a straight line in its octave; three pieces make it resemble a logarithm.
    const int exponent = value >> 11, m = value & 2047;
    const int mantissa = m < 512 ? 3 * m : m < 1536 ? 4 * m - 512 : 5 * m - 2048;
    return std::uint16_t(std::min(exponent << 10 | mantissa >> 3, 0x7bff));
}

void decode_astc(const AstcBlock& block, std::span<std::uint16_t, 48> rgb) {
    if (block.solid) {
        for (std::size_t i = 0; i < 48; ++i) rgb[i] = block.colour[i % 3];
        return;
    }
    const std::uint32_t pattern = block.subsets == 2 ? astc_partition(block.seed) : 0;
    AstcEndpoints ends[2];
    for (int s = 0; s < block.subsets; ++s)
        ends[s] = astc_endpoints(block.endpoint_mode, block.values.data() + s * endpoint_values(block.endpoint_mode));
    for (std::size_t i = 0; i < 16; ++i) {
        const AstcEndpoints& e = ends[pattern >> i & 1];
        const int w = ise_weight(block.weight_range, ise_weight_number(block.weight_range, block.weights[i]));
        for (std::size_t c = 0; c < 3; ++c)
            rgb[3 * i + c] = half_from_astc((e.low[c] * 16 * (64 - w) + e.high[c] * 16 * w + 32) >> 6);
    }
}

}  // namespace domelight
