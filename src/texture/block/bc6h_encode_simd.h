#pragma once

#include "domelight/texture/texture.h"

#include <cstdint>

namespace domelight::simd {

/// bc6h::encode_plain with a block in each lane of the machine's vectors, chosen at run time: the same bytes.
void bc6h_encode(const float* texels, int count, EncodingQuality quality, std::uint8_t* blocks);

}  // namespace domelight::simd
