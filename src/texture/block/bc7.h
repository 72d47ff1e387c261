#pragma once

#include "texture/block/bc123.h"

#include <cstdint>

namespace domelight {

/// A block of BC7 (Khronos Data Format 1.3, section 20; Direct3D 11.3 Functional Specification, 19.5). Any 16 bytes: a block of the
/// reserved mode is transparent black.
Rgba8Block decode_bc7(const std::uint8_t* block);

}  // namespace domelight
