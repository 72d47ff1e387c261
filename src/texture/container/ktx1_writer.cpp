// Writes KTX 1.1 (Khronos KTX File Format Specification, version 1.1), which Filament loads.
#include "domelight/texture/texture.h"

#include "io/file/byte_buffer.h"
#include "texture/container/ktx1.h"
#include "texture/container/scaled_bytes.h"
#include "texture/container/texture_layout.h"

#include <map>
#include <string>

namespace domelight {

namespace {

/// An encoding in OpenGL's terms.
struct GlFormat {
    std::uint32_t internal_format, type, type_bytes, format, base_format;
};

GlFormat gl_format(Encoding encoding) {
    constexpr std::uint32_t k_half = 0x140b, k_float = 0x1406, k_rgba = 0x1908, k_rgb = 0x1907, k_rg = 0x8227,
                            k_red = 0x1903;
    switch (encoding) {
        case Encoding::rgba16f:
            return {k_gl_rgba16f, k_half, 2, k_rgba, k_rgba};
        case Encoding::rgba32f:
            return {k_gl_rgba32f, k_float, 4, k_rgba, k_rgba};
        case Encoding::rg16f:
            return {k_gl_rg16f, k_half, 2, k_rg, k_rg};
        case Encoding::rg32f:
            return {k_gl_rg32f, k_float, 4, k_rg, k_rg};
        case Encoding::r32f:
            return {k_gl_r32f, k_float, 4, k_red, k_red};
        case Encoding::rgb9e5:
            return {k_gl_rgb9_e5, 0x8c3e, 4, k_rgb, k_rgb};  // UNSIGNED_INT_5_9_9_9_REV
        case Encoding::rgbm:
        case Encoding::rgbd:
        case Encoding::rgbp:
            return {k_gl_rgba8, k_gl_unsigned_byte, 1, k_rgba, k_rgba};
        case Encoding::bc6h:
            return {k_gl_bptc_unsigned_float, 0, 1, 0, k_rgb};  // compressed: neither type nor format
        case Encoding::uastc_hdr:
        case Encoding::astc4x4_hdr:
            return {k_gl_astc4x4, 0, 1, 0, k_rgba};
        case Encoding::astc6x6_hdr:
            return {k_gl_astc6x6, 0, 1, 0, k_rgba};
        case Encoding::r11g11b10f:
            break;
    }
    // The type should be UNSIGNED_INT_10F_11F_11F_REV, 0x8c3b. Filament, the only engine that reads the format, writes
    // and expects the internal format here and rejects the right value; readers that look at the internal format accept
    // both.
    return {k_gl_r11f_g11f_b10f, k_gl_r11f_g11f_b10f, 4, k_rgb, k_rgb};
}

bool is_reserved(const std::string& key) {
    return key.starts_with("KTX") || key.starts_with("ktx");
}

}  // namespace

Result<TextureLayout> ktx1_layout(const Texture& texture, std::span<const std::uint64_t> level_bytes) {
    ByteBuffer key_values;
    std::map<std::string, std::string> metadata = texture.metadata;
    note_scaled_bytes(texture.encoding, metadata);
    for (const auto& [key, value] : metadata) {
        if (is_reserved(key)) continue;
        key_values.u32(std::uint32_t(key.size() + 1 + value.size() + 1));
        key_values.text(key);
        key_values.u8(0);
        key_values.text(value);
        key_values.u8(0);
        key_values.align(4);
    }
    const GlFormat gl = gl_format(texture.encoding);
    ByteBuffer head;
    for (std::uint8_t byte : k_ktx1_identifier) head.u8(byte);
    head.u32(k_ktx1_endianness);
    head.u32(gl.type);
    head.u32(gl.type_bytes);
    head.u32(gl.format);
    head.u32(gl.internal_format);
    head.u32(gl.base_format);
    head.u32(std::uint32_t(texture.width));
    head.u32(std::uint32_t(texture.height));
    head.u32(0);  // depth
    head.u32(0);  // array elements
    head.u32(std::uint32_t(texture.faces));
    head.u32(std::uint32_t(level_bytes.size()));
    head.u32(std::uint32_t(key_values.size()));

    TextureLayout layout;
    head.append(key_values.bytes());
    for (std::size_t l = 0; l < level_bytes.size(); ++l) {
        // For a cube, imageSize counts one face. Rows, faces and levels are multiples of 4 bytes in all our encodings:
        // no padding.
        const std::uint64_t face_bytes = level_bytes[l] / std::uint64_t(texture.faces);
        if (face_bytes > 0xffffffffu)
            return Error{"a face of more than 4 GiB does not fit into KTX 1", "", "write KTX2"};
        head.u32(std::uint32_t(face_bytes));
        layout.frame.push_back({layout.size, head.take()});
        layout.size += layout.frame.back().bytes.size();
        layout.blocks.push_back({layout.size, int(l), 0, texture.faces});
        layout.size += level_bytes[l];
    }
    if (head.size() > 0) layout.frame.push_back({0, head.take()});  // no levels at all
    return layout;
}

Result<void> write_ktx1(const std::filesystem::path& file, const Texture& texture) {
    const auto layout = ktx1_layout(texture, level_bytes_of(texture));
    if (!layout) return layout.error().at(file.string());
    return write_with_layout(file, *layout, texture.faces, texture.levels);
}

Result<TexelBytes> ktx1_bytes(const Texture& texture) {
    const auto layout = ktx1_layout(texture, level_bytes_of(texture));
    if (!layout) return layout.error();
    return bytes_with_layout(*layout, texture.faces, texture.levels);
}

}  // namespace domelight
