// Writes KTX 2.0 (Khronos KTX File Format Specification, version 2.0; section numbers are its).
#include "domelight/base/version.h"
#include "domelight/texture/texture.h"

#include "io/file/byte_buffer.h"
#include "texture/container/ktx2.h"
#include "texture/container/scaled_bytes.h"
#include "texture/container/texture_layout.h"

#include <zstd.h>

#include <map>
#include <string>
#include <vector>

namespace domelight {

namespace {

/// Flags of a sample's channel in the basic descriptor block (Khronos Data Format Specification 1.3, section 5.12).
enum : unsigned {
    k_red = 0,
    k_green = 1,
    k_blue = 2,
    k_alpha = 15,
    k_exponent = 0x20,
    k_signed = 0x40,
    k_float = 0x80
};

struct Sample {
    unsigned bit_offset, bit_length, channel;
    std::uint32_t lower, upper;
};

constexpr std::uint32_t k_one = 0x3f800000, k_minus_one = 0xbf800000;  // as floats

std::vector<Sample> samples_of(Encoding encoding) {
    const auto signed_floats = [](unsigned bits, std::initializer_list<unsigned> channels) {
        std::vector<Sample> samples;
        for (unsigned c : channels)
            samples.push_back({unsigned(samples.size()) * bits, bits, c | k_float | k_signed, k_minus_one, k_one});
        return samples;
    };
    switch (encoding) {
        case Encoding::rgba16f:
            return signed_floats(16, {k_red, k_green, k_blue, k_alpha});
        case Encoding::rgba32f:
            return signed_floats(32, {k_red, k_green, k_blue, k_alpha});
        case Encoding::rg16f:
            return signed_floats(16, {k_red, k_green});
        case Encoding::rg32f:
            return signed_floats(32, {k_red, k_green});
        case Encoding::r32f:
            return signed_floats(32, {k_red});
        case Encoding::r11g11b10f:
            return {{0, 11, k_red | k_float, 0, k_one},
                    {11, 11, k_green | k_float, 0, k_one},
                    {22, 10, k_blue | k_float, 0, k_one}};
        case Encoding::rgbm:
        case Encoding::rgbd:
        case Encoding::rgbp:
            return {{0, 8, k_red, 0, 255}, {8, 8, k_green, 0, 255}, {16, 8, k_blue, 0, 255}, {24, 8, k_alpha, 0, 255}};
        case Encoding::bc6h:
        case Encoding::uastc_hdr:
            return {{0, 128, k_red | k_float, 0, k_one}};  // channel 0 of these models is their colour
        case Encoding::astc4x4_hdr:
        case Encoding::astc6x6_hdr:
            return {{0, 128, k_red | k_float | k_signed, k_minus_one, k_one}};  // as for all of ASTC's SFLOAT formats
        case Encoding::rgb9e5:
            break;
    }
    // Mantissa and exponent are separate samples; the five exponent bits are shared by all channels. 8448 is the
    // mantissa of 1.0 at the exponent's bias, 15 (Data Format Specification 1.3, table of the shared-exponent example).
    std::vector<Sample> samples;
    for (unsigned c : {k_red, k_green, k_blue}) {
        samples.push_back({9 * c, 9, c, 0, 8448});
        samples.push_back({27, 5, c | k_exponent, 15, 31});
    }
    return samples;
}

/// Colour model of an encoding (Khronos Data Format Specification 1.3, section 5.6).
unsigned colour_model(Encoding encoding) {
    switch (encoding) {
        case Encoding::bc6h:
            return 133;  // KHR_DF_MODEL_BC6H
        case Encoding::uastc_hdr:
            return k_model_uastc_hdr;  // states that the blocks can be turned into BC6H
        case Encoding::astc4x4_hdr:
        case Encoding::astc6x6_hdr:
            return 162;  // KHR_DF_MODEL_ASTC
        default:
            return 1;  // KHR_DF_MODEL_RGBSDA
    }
}

/// The data format descriptor: its total size and one basic block.
void append_descriptor(ByteBuffer& out, Encoding encoding) {
    const std::vector<Sample> samples = samples_of(encoding);
    const unsigned block_size = 24 + 16 * unsigned(samples.size());
    out.u32(4 + block_size);
    out.u32(0);  // vendor Khronos, type basic
    out.u16(2);  // version 1.3
    out.u16(block_size);
    out.u8(colour_model(encoding));
    out.u8(1);  // primaries BT.709
    out.u8(1);  // transfer function linear
    out.u8(0);  // straight alpha
    const unsigned side = unsigned(encoding_block(encoding)) - 1;
    out.u32(side | side << 8);  // texel block, each dimension less one
    // bytesPlane[0]. Revisions of the specification before 2025 required 0 for supercompressed levels; the current one
    // keeps the bytes and warns of 0, and readers accept both ("DFD for Supercompressed Data").
    out.u8(unsigned(encoding_bytes(encoding)));
    for (int i = 1; i < 8; ++i) out.u8(0);
    for (const Sample& s : samples) {
        out.u16(s.bit_offset);
        out.u8(s.bit_length - 1);
        out.u8(s.channel);
        out.u32(0);  // position
        out.u32(s.lower);
        out.u32(s.upper);
    }
}

/// The size of the numbers whose bytes a change of endianness swaps.
std::uint32_t type_bytes(Encoding encoding) {
    if (encoding_block(encoding) > 1 || is_scaled_bytes(encoding)) return 1;
    return encoding == Encoding::rgba16f || encoding == Encoding::rg16f ? 2 : 4;
}

/// Key/value data, sorted by key (std::map's order is that of the bytes), each padded to 4 bytes; values are text with
/// a terminator.
void append_key_values(ByteBuffer& out, const std::map<std::string, std::string>& metadata) {
    for (const auto& [key, value] : metadata) {
        out.u32(std::uint32_t(key.size() + 1 + value.size() + 1));
        out.text(key);
        out.u8(0);
        out.text(value);
        out.u8(0);
        out.align(4);
    }
}

/// The keys of the texture and of the container. Values of reserved keys from another file are not copied, because they
/// need not be true of this one.
std::map<std::string, std::string> complete_metadata(const Texture& texture, const TextureArray& array) {
    std::map<std::string, std::string> metadata = texture.metadata;
    std::erase_if(metadata,
                  [](const auto& pair) { return pair.first.starts_with("KTX") || pair.first.starts_with("ktx"); });
    note_scaled_bytes(texture.encoding, metadata);
    // Right, down, in: rows run from top to bottom, and slices away from the viewer.
    metadata["KTXorientation"] = array.depth > 0 ? "rdi" : "rd";
    metadata["KTXwriter"] = "Domelight " + std::string(version());
    return metadata;
}

std::uint64_t align_up(std::uint64_t n, std::uint64_t alignment) {
    return (n + alignment - 1) / alignment * alignment;
}

Result<std::vector<TexelBytes>> compress_levels(const Texture& texture) {
    std::vector<TexelBytes> packed;
    for (const auto& level : texture.levels) {
        TexelBytes& out = packed.emplace_back(ZSTD_compressBound(level.size()));
        const std::size_t n = ZSTD_compress(out.data(), out.size(), level.data(), level.size(), 3);
        if (ZSTD_isError(n)) return Error{std::string("zstd: ") + ZSTD_getErrorName(n), "", ""};
        out.resize(n);
    }
    return packed;
}

}  // namespace

Result<TextureLayout> ktx2_layout(const Texture& texture, std::span<const std::uint64_t> level_bytes,
                                  Supercompression compression, std::span<const std::uint64_t> stored_bytes,
                                  const TextureArray& array) {
    const std::size_t level_count = level_bytes.size();

    ByteBuffer descriptor, key_values;
    append_descriptor(descriptor, texture.encoding);
    append_key_values(key_values, complete_metadata(texture, array));
    const std::uint64_t descriptor_at = k_ktx2_header_bytes + k_ktx2_level_bytes * level_count,
                        key_values_at = descriptor_at + descriptor.size();

    // Levels lie from the smallest to the largest, each on a multiple of lcm(block bytes, 4); packed ones without gaps
    // (section 3.9.7).
    const std::uint64_t alignment =
        compression == Supercompression::none ? std::uint64_t(encoding_bytes(texture.encoding)) : 1;
    std::vector<std::uint64_t> offset(level_count);
    std::uint64_t end = key_values_at + key_values.size();
    for (std::size_t l = level_count; l-- > 0;) {
        offset[l] = align_up(end, alignment);
        end = offset[l] + stored_bytes[l];
    }

    ByteBuffer head;
    for (std::uint8_t byte : k_ktx2_identifier) head.u8(byte);
    head.u32(vulkan_format(texture.encoding));
    head.u32(type_bytes(texture.encoding));
    head.u32(std::uint32_t(texture.width));
    head.u32(std::uint32_t(texture.height));
    head.u32(std::uint32_t(array.depth));
    head.u32(std::uint32_t(array.layers));
    head.u32(std::uint32_t(texture.faces));
    head.u32(std::uint32_t(level_count));
    head.u32(compression == Supercompression::zstd ? 2 : 0);
    head.u32(std::uint32_t(descriptor_at));
    head.u32(std::uint32_t(descriptor.size()));
    head.u32(std::uint32_t(key_values_at));
    head.u32(std::uint32_t(key_values.size()));
    head.u64(0);  // no supercompression global data
    head.u64(0);
    for (std::size_t l = 0; l < level_count; ++l) {
        head.u64(offset[l]);
        head.u64(stored_bytes[l]);
        head.u64(level_bytes[l]);
    }

    head.append(descriptor.bytes());
    head.append(key_values.bytes());

    TextureLayout layout;
    layout.frame.push_back({0, head.take()});
    layout.size = layout.frame.back().bytes.size();
    for (std::size_t l = level_count; l-- > 0;) {
        if (offset[l] > layout.size)
            layout.frame.push_back({layout.size, std::vector<std::uint8_t>(std::size_t(offset[l] - layout.size), 0)});
        layout.blocks.push_back({offset[l], int(l), 0, texture.faces});
        layout.size = offset[l] + stored_bytes[l];
    }
    return layout;
}

namespace {

/// A texture as a file holds it.
struct StoredKtx2 {
    TextureLayout layout;
    std::vector<TexelBytes> packed;  ///< the levels, where they are compressed
};

Result<StoredKtx2> stored_ktx2(const Texture& texture, Supercompression compression) {
    StoredKtx2 stored;
    const auto level_bytes = level_bytes_of(texture);
    std::vector<std::uint64_t> stored_bytes = level_bytes;
    if (compression != Supercompression::none) {
        auto packed = compress_levels(texture);
        if (!packed) return packed.error();
        stored.packed = *std::move(packed);
        for (std::size_t l = 0; l < stored_bytes.size(); ++l) stored_bytes[l] = stored.packed[l].size();
    }
    auto layout = ktx2_layout(texture, level_bytes, compression, stored_bytes);
    if (!layout) return layout.error();
    stored.layout = *std::move(layout);
    return stored;
}

}  // namespace

Result<void> write_ktx2(const std::filesystem::path& file, const Texture& texture, Supercompression compression) {
    const auto stored = stored_ktx2(texture, compression);
    if (!stored) return stored.error().at(file.string());
    const bool packed = compression != Supercompression::none;
    return write_with_layout(file, stored->layout, texture.faces, packed ? stored->packed : texture.levels);
}

Result<TexelBytes> ktx2_bytes(const Texture& texture, Supercompression compression) {
    const auto stored = stored_ktx2(texture, compression);
    if (!stored) return stored.error();
    const bool packed = compression != Supercompression::none;
    return bytes_with_layout(stored->layout, texture.faces, packed ? stored->packed : texture.levels);
}

}  // namespace domelight
