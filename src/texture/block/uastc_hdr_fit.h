#pragma once

#include "texture/block/astc_block.h"

#include <cstdint>

namespace domelight::simd {

/// The most blocks that one call of fit_uastc_hdr takes.
inline constexpr int k_uastc_batch = 16;

/// How long to search.
struct UastcEffort {
    int passes = 2;      ///< from weights to ends and back
    int partitions = 1;  ///< how many of the 27 partitions are tried, the most promising first
};

/// Finds a UASTC HDR block for each of `count` (up to k_uastc_batch) blocks of 4 x 4 texels, row by row, RGB, from 0 to
/// k_uastc_hdr_max and never NaN. Each lane of a vector holds a block; the result is the same on every instruction set.
///
/// The error that is minimised is the sum of squares on ASTC's own scale, which is the logarithm of radiance
/// approximated by three straight pieces in each octave: the error that a viewer sees at any exposure. Green counts a
/// little more, blue less.
void fit_uastc_hdr(const float* rgb, int count, UastcEffort effort, AstcBlock* blocks);

}  // namespace domelight::simd
