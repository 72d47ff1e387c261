#pragma once

#include "domelight/texture/texture.h"

#include "texture/texel/encode_row.h"

#include <cstdint>

namespace domelight {

/// The functions of an encoding in blocks. A block's texels are RGB floats, row by row, side * side of them; blocks and
/// their texels lie one after the other.
struct BlockCodec {
    float min, max;  ///< of a channel
    /// Texels are inside the range; none is NaN. The bytes of a block do not depend on the other blocks.
    void (*encode)(const float* texels, int count, EncodingQuality quality, std::uint8_t* blocks);
    /// Any bytes.
    void (*decode)(const std::uint8_t* blocks, int count, float* texels);
};

/// Null for encodings of single texels.
const BlockCodec* block_codec(Encoding encoding);

/// Encodes one row of blocks: `rows` (at most the block's side) rows of `width` RGB texels one after the other, with
/// `weight[y][x]` for the sums. Missing texels of a block at the right and at the bottom are filled with its last
/// column and row.
EncodeSums encode_block_row(Encoding encoding, EncodingQuality quality, const float* rgb, int width, int rows,
                            const float* const* weight, float log_floor, std::uint8_t* out);

/// RGB texels, width x height, of rows of blocks.
void decode_blocks(Encoding encoding, const std::uint8_t* blocks, int width, int height, float* rgb);

}  // namespace domelight
