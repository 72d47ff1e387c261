#pragma once
// Constants of Babylon's .env container (its environmentTextureTools) for the reader and the writer. A file consists of
// eight bytes, JSON that ends in a zero, and pictures at the offsets that the JSON states, counted from the end of that
// zero.

#include "domelight/texture/container/babylon_env.h"

#include "io/file/byte_source.h"

#include <array>
#include <cstdint>

namespace domelight {

inline constexpr std::array<std::uint8_t, 8> k_env_magic{0x86, 0x16, 0x87, 0x96, 0xf6, 0xd6, 0x96, 0x36};
/// The longest JSON that is read: that of 15 levels has 8 KiB.
inline constexpr std::uint64_t k_max_env_json = 1 << 20;
/// The widest cube that is accepted.
inline constexpr int k_max_env_width = 1 << 14;

/// Babylon uploads its pictures upside down: the last row of the picture is the first of the face.
void flip_faces(Texture& cube);

Result<BabylonEnv> env_file(ByteSource& source);
Result<TextureInfo> env_info(ByteSource& source);

}  // namespace domelight
