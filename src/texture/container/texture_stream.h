#pragma once

#include "domelight/texture/texture.h"

#include "texture/container/texture_layout.h"

namespace domelight {

class ChainEncoder;

/// Encodes a chain and writes its file at the same time, on all threads: each piece of texels is stored (and hashed)
/// while it is in the processor's cache, and the encoded chain never exists in memory. Returns the SHA-256 of the file,
/// or nothing where `hash` is false. The file appears whole or not at all; it can only be a regular one.
Result<std::string> encode_to_file(const std::filesystem::path& file, ChainEncoder& encoder,
                                   const TextureLayout& layout, int threads, bool hash);

}  // namespace domelight
