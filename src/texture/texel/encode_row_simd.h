#pragma once

#include "texture/texel/encode_row.h"

namespace domelight::simd {

/// encode_row_scalar in vectors of the machine's width, chosen at run time: the same bytes; the sums are float over a
/// row and so differ in their last digits. Encodings and machines without a faster form use the scalar one.
EncodeSums encode_row(Encoding encoding, const float* rgb, int count, const float* weight, float log_floor,
                      std::uint8_t* out);

/// compare_row_scalar in the same way.
EncodeSums compare_row(const float* rgb, const float* stored, int count, const float* weight, float low, float high,
                       float log_floor);

}  // namespace domelight::simd
