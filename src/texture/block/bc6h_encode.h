#pragma once

#include "domelight/texture/texture.h"

#include <cstdint>

namespace domelight::bc6h {

/// How much is tried.
struct Effort {
    int partitions = 0;       ///< of the 32, the most promising; 0: modes of one subset alone
    int fits = 1;             ///< rounds of nearest indices and least squares before anything is quantised
    int refits = 1;           ///< and with each mode's quantised ends
    int polish = 0;           ///< the most rounds of moving single ends of the best block by steps
    int nudges = 0;           ///< the same of every mode and partition's, before the best is chosen
    float step = 2;           ///< the longest of them
    float reach = 1;          ///< only where a mode's error is below this times the best one found without
    bool neighbours = false;  ///< tries the indices beside a texel's projection on the line, too
};
Effort effort_of(EncodingQuality quality);

/// Packs ends given as whole numbers of the mode's precision ([end][channel], not yet as differences).
void pack_solution(int mode, int partition, const int* ends, const int* index, std::uint8_t* block);

/// Encodes `count` blocks of 16 RGB texels each, every channel from 0 to 65504. The plain form; texture/block/bc6h_encode_simd.h
/// gives the same bytes.
void encode_plain(const float* texels, int count, EncodingQuality quality, std::uint8_t* blocks);

}  // namespace domelight::bc6h
