#pragma once

#include "domelight/texture.h"

#include <cstdint>

namespace domelight::bc6h {

/// Encodes `count` blocks of 16 RGB texels each, every channel from 0 to 65504.
void encode(const float* texels, int count, EncodingQuality quality, std::uint8_t* blocks);

}  // namespace domelight::bc6h
