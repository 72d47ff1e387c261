#include "texture/block/block_codec.h"

#include "texture/block/astc_codec.h"
#include "texture/block/bc6h.h"
#include "texture/block/bc6h_encode_simd.h"
#include "texture/block/uastc_hdr.h"
#include "texture/texel/encode_row_simd.h"
#include "texture/texel/half.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace domelight {

namespace {

/// The number of blocks gathered at a time: as many as the widest vectors hold, and few enough for the processor's
/// caches.
constexpr int k_blocks_at_once = 32;

void decode_bc6h(const std::uint8_t* blocks, int count, float* texels) {
    for (int i = 0; i < count; ++i) bc6h::decode(blocks + 16 * i, texels + 48 * i);
}

constexpr BlockCodec k_bc6h{0, k_half_max, simd::bc6h_encode, decode_bc6h};

constexpr BlockCodec k_uastc_hdr{0, k_uastc_hdr_max, encode_uastc_hdr, decode_uastc_hdr};

template <int side>
void encode_astc_blocks(const float* texels, int count, EncodingQuality quality, std::uint8_t* blocks) {
    encode_astc_hdr(side, texels, count, quality, blocks);
}

template <int side>
void decode_astc_blocks(const std::uint8_t* blocks, int count, float* texels) {
    decode_astc_hdr(side, blocks, count, texels);
}

template <int side>
constexpr BlockCodec k_astc_hdr{0, k_half_max, encode_astc_blocks<side>, decode_astc_blocks<side>};

}  // namespace

const BlockCodec* block_codec(Encoding encoding) {
    switch (encoding) {
        case Encoding::bc6h:
            return &k_bc6h;
        case Encoding::uastc_hdr:
            return &k_uastc_hdr;
        case Encoding::astc4x4_hdr:
            return &k_astc_hdr<4>;
        case Encoding::astc6x6_hdr:
            return &k_astc_hdr<6>;
        default:
            return nullptr;
    }
}

EncodeSums encode_block_row(Encoding encoding, EncodingQuality quality, const float* rgb, int width, int rows,
                            const float* const* weight, float log_floor, std::uint8_t* out) {
    const BlockCodec& codec = *block_codec(encoding);
    const int side = encoding_block(encoding), block_floats = 3 * side * side, columns = (width + side - 1) / side;
    assert(rows >= 1 && rows <= side);
    std::vector<float> texels(std::size_t(k_blocks_at_once * block_floats)),
        row(std::size_t(3 * k_blocks_at_once * side));
    EncodeSums sums;
    for (int first = 0; first < columns; first += k_blocks_at_once) {
        const int count = std::min(k_blocks_at_once, columns - first), left = side * first,
                  texel_columns = std::min(side * count, width - left);
        float* to = texels.data();
        for (int b = 0; b < count; ++b)
            for (int i = 0; i < side * side; ++i) {
                const int x = std::min(left + b * side + i % side, width - 1), y = std::min(i / side, rows - 1);
                const float* from = rgb + 3 * (std::size_t(width) * std::size_t(y) + std::size_t(x));
                for (int c = 0; c < 3; ++c) *to++ = limit_to(from[c], codec.min, codec.max);
            }
        codec.encode(texels.data(), count, quality, out);
        codec.decode(out, count, texels.data());
        out += std::size_t(count) * std::size_t(encoding_bytes(encoding));
        for (int y = 0; y < rows; ++y) {
            for (int b = 0; b < count; ++b)
                std::copy_n(texels.data() + b * block_floats + 3 * side * y, 3 * side, row.data() + 3 * side * b);
            sums += simd::compare_row(rgb + 3 * (std::size_t(width) * std::size_t(y) + std::size_t(left)), row.data(),
                                      texel_columns, weight[y] + left, codec.min, codec.max, log_floor);
        }
    }
    return sums;
}

void decode_blocks(Encoding encoding, const std::uint8_t* blocks, int width, int height, float* rgb) {
    const BlockCodec& codec = *block_codec(encoding);
    const int side = encoding_block(encoding), bytes = encoding_bytes(encoding);
    std::vector<float> texels(std::size_t(3 * side * side));
    for (int top = 0; top < height; top += side)
        for (int left = 0; left < width; left += side, blocks += bytes) {
            codec.decode(blocks, 1, texels.data());
            for (int y = 0; y < std::min(side, height - top); ++y)
                std::copy_n(texels.data() + 3 * side * y, 3 * std::min(side, width - left),
                            rgb + 3 * (std::size_t(width) * std::size_t(top + y) + std::size_t(left)));
        }
}

}  // namespace domelight
