#include "codec/block_codec.h"

#include "codec/bc6h.h"
#include "codec/half.h"
#include "simd/bc6h_encode.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace domelight {

namespace {

/// Blocks that are gathered at once: as many as the widest vectors take, and few enough for the processor's caches.
constexpr int k_blocks_at_once = 32;

void decode_bc6h(const std::uint8_t* blocks, int count, float* texels) {
    for (int i = 0; i < count; ++i) bc6h::decode(blocks + 16 * i, texels + 48 * i);
}

constexpr BlockCodec k_bc6h{0, k_half_max, simd::bc6h_encode, decode_bc6h};

Vec3f texel_at(const float* p) {
    return {p[0], p[1], p[2]};
}

}  // namespace

const BlockCodec* block_codec(Encoding encoding) {
    return encoding == Encoding::bc6h ? &k_bc6h : nullptr;
}

EncodeSums encode_block_row(Encoding encoding, EncodingQuality quality, const float* rgb, int width, int rows,
                            const float* const* weight, std::uint8_t* out) {
    const BlockCodec& codec = *block_codec(encoding);
    const int side = encoding_block(encoding), block_floats = 3 * side * side, columns = (width + side - 1) / side;
    assert(rows >= 1 && rows <= side);
    std::vector<float> texels(std::size_t(k_blocks_at_once * block_floats)), stored(texels.size());
    EncodeSums sums;
    for (int first = 0; first < columns; first += k_blocks_at_once) {
        const int count = std::min(k_blocks_at_once, columns - first);
        const auto for_texels = [&](auto use) {
            for (int b = 0; b < count; ++b)
                for (int i = 0; i < side * side; ++i)
                    use(b * block_floats + 3 * i, side * (first + b) + i % side, i / side);
        };
        for_texels([&](int at, int x, int y) {
            const float* from = rgb + 3 * (std::size_t(width) * std::size_t(std::min(y, rows - 1)) +
                                           std::size_t(std::min(x, width - 1)));
            for (int c = 0; c < 3; ++c) texels[std::size_t(at + c)] = limit_to(from[c], codec.min, codec.max);
        });
        codec.encode(texels.data(), count, quality, out);
        codec.decode(out, count, stored.data());
        out += std::size_t(count) * std::size_t(encoding_bytes(encoding));
        for_texels([&](int at, int x, int y) {
            if (x >= width || y >= rows) return;
            sums.add(texel_at(rgb + 3 * (std::size_t(width) * std::size_t(y) + std::size_t(x))),
                     texel_at(texels.data() + at), texel_at(stored.data() + at), weight[y][x]);
        });
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
