#pragma once

#include "domelight/texture/texture.h"

#include <cstdint>

namespace domelight::bc6h {

/// The effort of the search.
struct Effort {
    int partitions = 0;       ///< how many of the 32 partitions, the most promising first; 0: only modes of one subset
    int fits = 1;             ///< rounds of nearest indices and least squares before quantisation
    int refits = 1;           ///< the same with the quantised ends of each mode
    int polish = 0;           ///< the largest number of rounds in which single ends of the best block are moved by
                              ///< steps
    int nudges = 0;           ///< the same for the block of every mode and partition, before the best is chosen
    float step = 2;           ///< the largest step
    float reach = 1;          ///< only if a mode's error is below this times the best one found without moving
    bool neighbours = false;  ///< tries the indices beside a texel's projection on the line, too
};
Effort effort_of(EncodingQuality quality);

/// Packs ends given as whole numbers of the mode's precision ([end][channel], not yet as differences).
void pack_solution(int mode, int partition, const int* ends, const int* index, std::uint8_t* block);

/// Encodes `count` blocks of 16 RGB texels each, every channel from 0 to 65504. The plain form; texture/block/bc6h_encode_simd.h
/// gives the same bytes.
void encode_plain(const float* texels, int count, EncodingQuality quality, std::uint8_t* blocks);

}  // namespace domelight::bc6h
