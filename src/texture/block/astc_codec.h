#pragma once

#include "domelight/texture/texture.h"

#include <cstdint>

namespace domelight {

/// Whether this build has Arm's codec; without it the functions below must not be called.
bool has_astc_codec();

/// Encodes `count` blocks of `side` x `side` RGB texels (4 or 6), row by row, from 0 to 65504 and never NaN, as ASTC
/// HDR of 16 bytes each, with Arm's encoder. The bytes of a block do not depend on the other blocks.
void encode_astc_hdr(int side, const float* rgb, int count, EncodingQuality quality, std::uint8_t* blocks);

/// The texels of any ASTC blocks of that size. An invalid block is black.
void decode_astc_hdr(int side, const std::uint8_t* blocks, int count, float* rgb);

}  // namespace domelight
