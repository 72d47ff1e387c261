#pragma once
// Functions shared by the readers of the three texture containers.

#include "domelight/io/decode.h"
#include "domelight/texture/texture.h"

#include "io/file/byte_source.h"
#include "texture/container/screen_texels.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

/// The largest size of a Texture that read_texture makes, whatever a header states.
inline constexpr std::uint64_t k_max_texture_bytes = std::uint64_t(2) << 30;
/// The longest side that is accepted.
inline constexpr std::uint32_t k_max_texture_side = 1u << 20;
/// The most key/value data that is read.
inline constexpr std::uint64_t k_max_metadata_bytes = std::uint64_t(16) << 20;

/// Texels or blocks as a file stores them and the encoding that holds them without loss: the same, or (texels) with the
/// missing channels filled in.
struct StoredTexels {
    Encoding encoding = Encoding::rgba16f;
    int channels = 0;       ///< stored; 0: exactly the encoding's texels or blocks
    int channel_bytes = 0;  ///< of a stored channel, where channels > 0
    /// Texels of eight bits a channel, which `decode` turns into `encoding`. The members above do not count then.
    std::optional<ScreenTexels> screen = {};
    Decode decode = Decode::automatic;
    /// Of a texel or block, where `screen` is empty.
    int bytes() const { return channels > 0 ? channels * channel_bytes : encoding_bytes(encoding); }
};

/// Texels of eight bits a channel: `decode` says what they mean, or, where it is automatic, their format does.
StoredTexels stored_screen_texels(const StatedScreenTexels& stated, Decode decode);

/// A number with its name, in decimal: "faceCount of 7".
std::string count_text(const char* name, std::uint64_t value);

/// Checks the sizes that every container states, and fills them in. `levels` 0 counts as 1. Errors: no width, a side
/// that is too long, a cube that is not square, more levels than the size has.
Result<void> set_shape(TextureInfo& info, std::uint64_t width, std::uint64_t height, std::uint64_t depth,
                       std::uint64_t layers, std::uint64_t faces, std::uint64_t levels);

/// The Texture of `info`'s shape without its texels, if read_texture can hold it: two-dimensional or cube, no array,
/// one of our encodings, not over k_max_texture_bytes.
Result<Texture> texture_for(const TextureInfo& info, const std::optional<StoredTexels>& texels);

/// Of level `l` as stored: the bytes of a row of texels or blocks without padding, and how many rows a face has.
std::uint64_t stored_row_bytes(const Texture& texture, const StoredTexels& texels, int l);
std::uint64_t stored_rows(const Texture& texture, const StoredTexels& texels, int l);
/// Bytes of level `l` as stored without padding, all faces. Cannot overflow after texture_for().
std::uint64_t stored_level_bytes(const Texture& texture, const StoredTexels& texels, int l);

/// Turns `count` stored texels or blocks into the encoding's, filling missing colours with 0 and alpha with 1.
void widen_texels(const StoredTexels& texels, const std::uint8_t* in, std::size_t count, std::uint8_t* out);

/// Converts the stored bytes of level `l`, without padding, to those of a Texture (in place if nothing changes).
Bytes widen_level(const Texture& texture, const StoredTexels& texels, int l, Bytes stored);

/// A metadata value as UTF-8 text: a terminator is removed; a value that is not text becomes "hex:" and its bytes.
std::string metadata_text(std::span<const std::uint8_t> value);
bool is_utf8_text(std::span<const std::uint8_t> bytes);

/// Parsers of the containers. `decode`: what texels of eight bits a channel mean (screen_texels.h). Automatic is what
/// the format states in KTX2 and KTX, and sRGB in DDS, whose formats seldom state it.
Result<TextureInfo> ktx2_info(ByteSource& source);
Result<Texture> ktx2_texture(ByteSource& source, Decode decode = Decode::automatic);
Result<TextureInfo> ktx1_info(ByteSource& source);
Result<Texture> ktx1_texture(ByteSource& source, Decode decode = Decode::automatic);
Result<TextureInfo> dds_info(ByteSource& source);
Result<Texture> dds_texture(ByteSource& source, Decode decode = Decode::automatic);

/// The texture of any of these kinds, and of a .env file. Errors name no file.
Result<TextureInfo> texture_info(ByteSource& source);
Result<Texture> texture(ByteSource& source, Decode decode = Decode::automatic);

/// read_texture() with that option.
Result<Texture> read_texture(const std::filesystem::path& file, Decode decode);

}  // namespace domelight
