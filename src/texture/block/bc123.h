#pragma once

#include <array>
#include <cstdint>

namespace domelight {

/// Sixteen texels of RGBA, row by row.
using Rgba8Block = std::array<std::array<std::uint8_t, 4>, 16>;

/// Blocks of the formats that came before BC4 (Direct3D documentation, "Block Compression"): DXT1; DXT2 and DXT3; DXT4
/// and DXT5. Any bytes. 8 bytes for BC1, 16 for the others.
Rgba8Block decode_bc1(const std::uint8_t* block);
Rgba8Block decode_bc2(const std::uint8_t* block);
Rgba8Block decode_bc3(const std::uint8_t* block);

}  // namespace domelight
