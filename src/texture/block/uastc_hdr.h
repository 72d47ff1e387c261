#pragma once
// UASTC HDR 4x4: those blocks of ASTC HDR 4x4 that turn into BC6H without a new search (Binomial's UASTC HDR 4x4
// texture specification). Any decoder of ASTC HDR decodes it.

#include "domelight/texture/texture.h"

#include "texture/block/astc_block.h"

#include <array>
#include <cstdint>
#include <span>

namespace domelight {

/// The brightest endpoint on ASTC's scale (1/128 octave) that UASTC HDR allows, and the value it stands for.
inline constexpr int k_uastc_end_max = 3967;
inline constexpr float k_uastc_hdr_max = 65216;

/// The partitions that ASTC and BC6H have in common, by ASTC's seed, in the order of BC6H's.
inline constexpr int k_uastc_partitions = 27;
inline constexpr std::array<std::uint16_t, k_uastc_partitions> k_uastc_seeds{
    28, 20, 16,  29,  91, 9,   107, 72,  149, 204, 50,  114, 496, 17,
    78, 39, 252, 828, 43, 156, 116, 210, 476, 273, 684, 359, 246};

/// The squared error of a block, in (1/128 octave)^2, above which two subsets are tried: half a step in every number.
inline constexpr float k_uastc_two_subsets_from = 48 * 0.25f;

/// Whether a block is one of the format's 24 modes.
bool is_uastc_hdr(const AstcBlock& block);

/// Encodes `count` blocks, each of 4 x 4 RGB texels row by row, into 16 bytes each. Values are clipped to 0 ..
/// k_uastc_hdr_max; NaN counts as 0. Deterministic.
void encode_uastc_hdr(const float* rgb, int count, EncodingQuality quality, std::uint8_t* out);

/// The texels of `count` blocks. A block that does not have this format is black.
void decode_uastc_hdr(const std::uint8_t* blocks, int count, float* rgb);

}  // namespace domelight
