#pragma once

#include "domelight/base/result.h"
#include "domelight/texture/texture.h"

#include <cstdint>
#include <span>
#include <vector>

namespace domelight {

/// The positions of a texture's bytes in a container's file.
struct TextureLayout {
    /// Header, keys or padding at a position.
    struct Frame {
        std::uint64_t offset;
        std::vector<std::uint8_t> bytes;
    };
    /// The texels of `faces` consecutive faces of a level, one after the other.
    struct Block {
        std::uint64_t offset;
        int level, first_face, faces;
    };
    std::vector<Frame> frame;   ///< everything but texels, from the front to the back
    std::vector<Block> blocks;  ///< all texels, from the front to the back
    std::uint64_t size = 0;     ///< of the file
};

/// The layout of a texture whose levels have, or are going to have, `level_bytes` bytes (all faces) each; the contents
/// of the levels of `texture` do not matter. Errors: a texture that the container cannot store.
Result<TextureLayout> ktx1_layout(const Texture& texture, std::span<const std::uint64_t> level_bytes);
Result<TextureLayout> dds_layout(const Texture& texture, std::span<const std::uint64_t> level_bytes);
/// DDS with the header from before DX10: half and float RGBA, RG only, as D3DFORMAT numbers.
Result<TextureLayout> dds9_layout(const Texture& texture, std::span<const std::uint64_t> level_bytes);
/// What a KTX2 file may hold besides one two-dimensional texture or one cube.
struct TextureArray {
    int layers = 0;  ///< textures or cubes one after the other; 0: it is no array
    int depth = 0;   ///< slices of a three-dimensional texture; 0: it is none
};
/// `stored_bytes`: of each level in the file, where they are compressed; else equal to `level_bytes`.
Result<TextureLayout> ktx2_layout(const Texture& texture, std::span<const std::uint64_t> level_bytes,
                                  Supercompression compression, std::span<const std::uint64_t> stored_bytes,
                                  const TextureArray& array = {});

/// Bytes of each of a texture's levels.
std::vector<std::uint64_t> level_bytes_of(const Texture& texture);

/// Writes levels from memory at the positions of a layout. The file appears whole or not at all.
Result<void> write_with_layout(const std::filesystem::path& file, const TextureLayout& layout, int faces,
                               std::span<const TexelBytes> levels);
/// The bytes of that file.
TexelBytes bytes_with_layout(const TextureLayout& layout, int faces, std::span<const TexelBytes> levels);

}  // namespace domelight
