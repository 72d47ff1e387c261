// The format: the positions of its bits and their meaning.
#include "texture/block/bc6h.h"

#include "texture/texel/half.h"

#include <string_view>

namespace domelight::bc6h {

const std::array<Mode, k_modes> k_mode{{
    {0x00, 2, 2, true, 10, {5, 5, 5}},
    {0x01, 2, 2, true, 7, {6, 6, 6}},
    {0x02, 5, 2, true, 11, {5, 4, 4}},
    {0x06, 5, 2, true, 11, {4, 5, 4}},
    {0x0a, 5, 2, true, 11, {4, 4, 5}},
    {0x0e, 5, 2, true, 9, {5, 5, 5}},
    {0x12, 5, 2, true, 8, {6, 5, 5}},
    {0x16, 5, 2, true, 8, {5, 6, 5}},
    {0x1a, 5, 2, true, 8, {5, 5, 6}},
    {0x1e, 5, 2, false, 6, {6, 6, 6}},
    {0x03, 5, 1, false, 10, {10, 10, 10}},
    {0x07, 5, 1, true, 11, {9, 9, 9}},
    {0x0b, 5, 1, true, 12, {8, 8, 8}},
    {0x0f, 5, 1, true, 16, {4, 4, 4}},
}};

const std::array<std::uint16_t, k_partitions> k_partition{
    0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80,
    0xe800, 0xffe8, 0xff00, 0xfff0, 0xf000, 0xf710, 0x008e, 0x7100, 0x08ce, 0x008c, 0x7310,
    0x3100, 0x8cce, 0x088c, 0x3110, 0x6666, 0x366c, 0x17e8, 0x0ff0, 0x718e, 0x399c};

const std::array<std::uint8_t, k_partitions> k_anchor{15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15,
                                                      15, 2,  8,  2,  2,  8,  8,  15, 2,  8,  2,  2,  8,  8,  2,  2};

namespace {

/// The bits between the mode's and the indices', in the specification's words: "r1 4:0" stands for bits 0 to 4 of red
/// of endpoint 1, lowest first; "r0 10:15" for 15 down to 10; d is the partition.
constexpr std::string_view k_layouts[k_modes] = {
    "g2 4 b2 4 b3 4 r0 9:0 g0 9:0 b0 9:0 r1 4:0 g3 4 g2 3:0 g1 4:0 b3 0 g3 3:0 b1 4:0 b3 1 b2 3:0 r2 4:0 b3 2 r3 4:0 "
    "b3 3 d0 4:0",
    "g2 5 g3 4 g3 5 r0 6:0 b3 0 b3 1 b2 4 g0 6:0 b2 5 b3 2 g2 4 b0 6:0 b3 3 b3 5 b3 4 r1 5:0 g2 3:0 g1 5:0 g3 3:0 "
    "b1 5:0 b2 3:0 r2 5:0 r3 5:0 d0 4:0",
    "r0 9:0 g0 9:0 b0 9:0 r1 4:0 r0 10 g2 3:0 g1 3:0 g0 10 b3 0 g3 3:0 b1 3:0 b0 10 b3 1 b2 3:0 r2 4:0 b3 2 r3 4:0 "
    "b3 3 d0 4:0",
    "r0 9:0 g0 9:0 b0 9:0 r1 3:0 r0 10 g3 4 g2 3:0 g1 4:0 g0 10 g3 3:0 b1 3:0 b0 10 b3 1 b2 3:0 r2 3:0 b3 0 b3 2 "
    "r3 3:0 g2 4 b3 3 d0 4:0",
    "r0 9:0 g0 9:0 b0 9:0 r1 3:0 r0 10 b2 4 g2 3:0 g1 3:0 g0 10 b3 0 g3 3:0 b1 4:0 b0 10 b2 3:0 r2 3:0 b3 1 b3 2 "
    "r3 3:0 b3 4 b3 3 d0 4:0",
    "r0 8:0 b2 4 g0 8:0 g2 4 b0 8:0 b3 4 r1 4:0 g3 4 g2 3:0 g1 4:0 b3 0 g3 3:0 b1 4:0 b3 1 b2 3:0 r2 4:0 b3 2 r3 4:0 "
    "b3 3 d0 4:0",
    "r0 7:0 g3 4 b2 4 g0 7:0 b3 2 g2 4 b0 7:0 b3 3 b3 4 r1 5:0 g2 3:0 g1 4:0 b3 0 g3 3:0 b1 4:0 b3 1 b2 3:0 r2 5:0 "
    "r3 5:0 d0 4:0",
    "r0 7:0 b3 0 b2 4 g0 7:0 g2 5 g2 4 b0 7:0 g3 5 b3 4 r1 4:0 g3 4 g2 3:0 g1 5:0 g3 3:0 b1 4:0 b3 1 b2 3:0 r2 4:0 "
    "b3 2 r3 4:0 b3 3 d0 4:0",
    "r0 7:0 b3 1 b2 4 g0 7:0 b2 5 g2 4 b0 7:0 b3 5 b3 4 r1 4:0 g3 4 g2 3:0 g1 4:0 b3 0 g3 3:0 b1 5:0 b2 3:0 r2 4:0 "
    "b3 2 r3 4:0 b3 3 d0 4:0",
    "r0 5:0 g3 4 b3 0 b3 1 b2 4 g0 5:0 g2 5 b2 5 b3 2 g2 4 b0 5:0 g3 5 b3 3 b3 5 b3 4 r1 5:0 g2 3:0 g1 5:0 g3 3:0 "
    "b1 5:0 b2 3:0 r2 5:0 r3 5:0 d0 4:0",
    "r0 9:0 g0 9:0 b0 9:0 r1 9:0 g1 9:0 b1 9:0",
    "r0 9:0 g0 9:0 b0 9:0 r1 8:0 r0 10 g1 8:0 g0 10 b1 8:0 b0 10",
    "r0 9:0 g0 9:0 b0 9:0 r1 7:0 r0 10:11 g1 7:0 g0 10:11 b1 7:0 b0 10:11",
    "r0 9:0 g0 9:0 b0 9:0 r1 3:0 r0 10:15 g1 3:0 g0 10:15 b1 3:0 b0 10:15",
};

/// One bit of a block: which number it belongs to (endpoint * 3 + channel; k_partition_field) and which bit of it.
struct FieldBit {
    std::uint8_t field, bit;
};
constexpr int k_partition_field = 12;

struct Layout {
    int count = 0;
    std::array<FieldBit, 80> bits{};
};

constexpr Layout parse_layout(std::string_view text) {
    Layout layout;
    std::size_t at = 0;
    const auto number = [&] {
        int value = 0;
        for (; at < text.size() && text[at] >= '0' && text[at] <= '9'; ++at) value = value * 10 + (text[at] - '0');
        return value;
    };
    while (at < text.size()) {
        const char channel = text[at++];
        const int endpoint = number();
        const int field = channel == 'd' ? k_partition_field
                                         : endpoint * 3 + (channel == 'r'   ? 0
                                                           : channel == 'g' ? 1
                                                                            : 2);
        ++at;  // space
        const int high = number();
        int low = high;
        if (at < text.size() && text[at] == ':') {
            ++at;
            low = number();
        }
        ++at;  // space, or the end
        // "4:0" runs from bit 0 up, "10:15" from bit 15 down.
        const int step = high >= low ? 1 : -1;
        for (int bit = low;; bit += step) {
            layout.bits[std::size_t(layout.count++)] = {std::uint8_t(field), std::uint8_t(bit)};
            if (bit == high) break;
        }
    }
    return layout;
}

constexpr std::array<Layout, k_modes> parse_layouts() {
    std::array<Layout, k_modes> layouts;
    for (int m = 0; m < k_modes; ++m) layouts[std::size_t(m)] = parse_layout(k_layouts[m]);
    return layouts;
}
constexpr std::array<Layout, k_modes> k_layout = parse_layouts();

/// The block as one number of 128 bits, read from its low end.
struct Bits {
    std::uint64_t low = 0, high = 0;

    explicit Bits(const std::uint8_t* bytes) {
        for (int i = 0; i < 8; ++i) {
            low |= std::uint64_t(bytes[i]) << 8 * i;
            high |= std::uint64_t(bytes[8 + i]) << 8 * i;
        }
    }
    /// 1 to 5 bits.
    int take(int count) {
        const int value = int(low & ((1u << count) - 1));
        low = low >> count | high << (64 - count);
        high >>= count;
        return value;
    }
};

/// The inverse: a number of 128 bits, filled from its low end.
struct BitWriter {
    std::uint64_t low = 0, high = 0;
    int at = 0;
    void put(int value, int count) {
        const std::uint64_t bits = std::uint64_t(value);
        if (at < 64) low |= bits << at;
        if (at >= 64) high |= bits << (at - 64);
        if (at < 64 && at + count > 64) high |= bits >> (64 - at);
        at += count;
    }
    void store(std::uint8_t* bytes) const {
        for (int i = 0; i < 8; ++i) {
            bytes[i] = std::uint8_t(low >> 8 * i);
            bytes[8 + i] = std::uint8_t(high >> 8 * i);
        }
    }
};

/// Bits of a texel's index: the anchors' top bit is not stored.
int stored_index_bits(const Fields& f, int texel) {
    const Mode& mode = k_mode[std::size_t(f.mode)];
    const bool anchor = texel == 0 || (mode.subsets == 2 && texel == k_anchor[std::size_t(f.partition)]);
    return mode.index_bits() - (anchor ? 1 : 0);
}

int sign_extend(int value, int bits) {
    return value & 1 << (bits - 1) ? value - (1 << bits) : value;
}

/// Mode by its first five bits; -1: reserved.
int mode_of(int five_bits) {
    const int code = (five_bits & 2) ? five_bits : five_bits & 3;
    for (int m = 0; m < k_modes; ++m)
        if (k_mode[std::size_t(m)].code == code) return m;
    return -1;
}

}  // namespace

void pack(const Fields& fields, std::uint8_t* block) {
    const Mode& mode = k_mode[std::size_t(fields.mode)];
    BitWriter out;
    out.put(mode.code, mode.code_bits);
    const Layout& layout = k_layout[std::size_t(fields.mode)];
    for (int i = 0; i < layout.count; ++i) {
        const auto [field, bit] = layout.bits[std::size_t(i)];
        const int value = field == k_partition_field ? fields.partition : fields.endpoint[field / 3u][field % 3u];
        out.put(value >> bit & 1, 1);
    }
    for (int t = 0; t < k_texels; ++t) out.put(fields.index[std::size_t(t)], stored_index_bits(fields, t));
    out.store(block);
}

bool unpack(const std::uint8_t* block, Fields& fields) {
    fields = {};
    fields.mode = mode_of(block[0] & 31);
    if (fields.mode < 0) return false;
    const Mode& mode = k_mode[std::size_t(fields.mode)];
    Bits in(block);
    in.take(mode.code_bits);
    const Layout& layout = k_layout[std::size_t(fields.mode)];
    for (int i = 0; i < layout.count; ++i) {
        const auto [field, bit] = layout.bits[std::size_t(i)];
        int& value = field == k_partition_field ? fields.partition : fields.endpoint[field / 3u][field % 3u];
        value |= in.take(1) << bit;
    }
    for (int t = 0; t < k_texels; ++t)
        fields.index[std::size_t(t)] = std::uint8_t(in.take(stored_index_bits(fields, t)));
    return true;
}

std::array<std::array<int, 3>, 4> endpoints(const Fields& fields) {
    const Mode& mode = k_mode[std::size_t(fields.mode)];
    auto ends = fields.endpoint;
    for (std::size_t c = 0; c < 3; ++c) {
        // Differences wrap round in the first endpoint's precision.
        if (mode.transformed)
            for (std::size_t e = 1; e < 4; ++e)
                ends[e][c] =
                    (ends[0][c] + sign_extend(ends[e][c], mode.delta_bits[c])) & ((1 << mode.endpoint_bits) - 1);
        for (auto& end : ends) end[c] = unquantise(end[c], mode.endpoint_bits);
    }
    return ends;
}

void decode(const std::uint8_t* block, HalfTexels& texels) {
    Fields fields;
    if (!unpack(block, fields)) {
        texels = {};
        return;
    }
    const Mode& mode = k_mode[std::size_t(fields.mode)];
    const auto ends = endpoints(fields);
    const int* weights = mode.subsets == 2 ? k_weights_3 : k_weights_4;
    const unsigned second = mode.subsets == 2 ? k_partition[std::size_t(fields.partition)] : 0u;
    for (std::size_t t = 0; t < k_texels; ++t) {
        const std::size_t subset = second >> t & 1u;
        const int w = weights[fields.index[t]];
        for (std::size_t c = 0; c < 3; ++c) {
            const int value = (ends[2 * subset][c] * (64 - w) + ends[2 * subset + 1][c] * w + 32) >> 6;
            texels[t][c] = std::uint16_t(half_bits(value));
        }
    }
}

void decode(const std::uint8_t* block, float* rgb) {
    HalfTexels texels;
    decode(block, texels);
    for (const auto& texel : texels)
        for (const std::uint16_t channel : texel) *rgb++ = float_from_half(channel);
}

}  // namespace domelight::bc6h
