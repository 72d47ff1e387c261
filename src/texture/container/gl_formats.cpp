// OpenGL's sized internal formats (OpenGL 4.6 core specification, tables 8.12 to 8.14, and the extensions of compressed
// formats).
#include "texture/container/gl_formats.h"

#include "texture/container/ktx1.h"

#include <cstdio>
#include <iterator>

namespace domelight {

namespace {

struct Name {
    std::uint32_t number;
    const char* name;
};

constexpr Name k_names[] = {
    {0x1903, "RED"},
    {0x1906, "ALPHA"},
    {0x1907, "RGB"},
    {0x1908, "RGBA"},
    {0x1909, "LUMINANCE"},
    {0x190a, "LUMINANCE_ALPHA"},
    {0x8227, "RG"},
    {0x8229, "R8"},
    {0x822a, "R16"},
    {0x822b, "RG8"},
    {0x822c, "RG16"},
    {k_gl_r16f, "R16F"},
    {k_gl_r32f, "R32F"},
    {k_gl_rg16f, "RG16F"},
    {k_gl_rg32f, "RG32F"},
    {0x8051, "RGB8"},
    {0x8054, "RGB16"},
    {0x8056, "RGBA4"},
    {0x8057, "RGB5_A1"},
    {k_gl_rgba8, "RGBA8"},
    {0x8059, "RGB10_A2"},
    {0x805b, "RGBA16"},
    {0x8d62, "RGB565"},
    {k_gl_rgba32f, "RGBA32F"},
    {k_gl_rgb32f, "RGB32F"},
    {k_gl_rgba16f, "RGBA16F"},
    {k_gl_rgb16f, "RGB16F"},
    {k_gl_r11f_g11f_b10f, "R11F_G11F_B10F"},
    {k_gl_rgb9_e5, "RGB9_E5"},
    {0x8c41, "SRGB8"},
    {0x8c43, "SRGB8_ALPHA8"},
    {0x8f94, "R8_SNORM"},
    {0x8f95, "RG8_SNORM"},
    {0x8f97, "RGBA8_SNORM"},
    {0x83f0, "COMPRESSED_RGB_S3TC_DXT1"},
    {0x83f1, "COMPRESSED_RGBA_S3TC_DXT1"},
    {0x83f2, "COMPRESSED_RGBA_S3TC_DXT3"},
    {0x83f3, "COMPRESSED_RGBA_S3TC_DXT5"},
    {0x8c4c, "COMPRESSED_SRGB_S3TC_DXT1"},
    {0x8c4d, "COMPRESSED_SRGB_ALPHA_S3TC_DXT1"},
    {0x8c4e, "COMPRESSED_SRGB_ALPHA_S3TC_DXT3"},
    {0x8c4f, "COMPRESSED_SRGB_ALPHA_S3TC_DXT5"},
    {0x8dbb, "COMPRESSED_RED_RGTC1"},
    {0x8dbc, "COMPRESSED_SIGNED_RED_RGTC1"},
    {0x8dbd, "COMPRESSED_RG_RGTC2"},
    {0x8dbe, "COMPRESSED_SIGNED_RG_RGTC2"},
    {0x8e8c, "COMPRESSED_RGBA_BPTC_UNORM"},
    {0x8e8d, "COMPRESSED_SRGB_ALPHA_BPTC_UNORM"},
    {0x8e8e, "COMPRESSED_RGB_BPTC_SIGNED_FLOAT"},
    {k_gl_bptc_unsigned_float, "COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT"},
    {0x8d64, "ETC1_RGB8"},
    {0x8c00, "COMPRESSED_RGB_PVRTC_4BPPV1"},
    {0x8c01, "COMPRESSED_RGB_PVRTC_2BPPV1"},
    {0x8c02, "COMPRESSED_RGBA_PVRTC_4BPPV1"},
    {0x8c03, "COMPRESSED_RGBA_PVRTC_2BPPV1"},
    {0x9270, "COMPRESSED_R11_EAC"},
    {0x9271, "COMPRESSED_SIGNED_R11_EAC"},
    {0x9272, "COMPRESSED_RG11_EAC"},
    {0x9273, "COMPRESSED_SIGNED_RG11_EAC"},
    {0x9274, "COMPRESSED_RGB8_ETC2"},
    {0x9275, "COMPRESSED_SRGB8_ETC2"},
    {0x9276, "COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2"},
    {0x9277, "COMPRESSED_SRGB8_PUNCHTHROUGH_ALPHA1_ETC2"},
    {0x9278, "COMPRESSED_RGBA8_ETC2_EAC"},
    {0x9279, "COMPRESSED_SRGB8_ALPHA8_ETC2_EAC"},
};

constexpr const char* k_astc_blocks[] = {"4x4", "5x4",  "5x5",  "6x5",  "6x6",   "8x5",   "8x6",
                                         "8x8", "10x5", "10x6", "10x8", "10x10", "12x10", "12x12"};

}  // namespace

std::string gl_format_name(std::uint32_t internal_format) {
    for (const Name& n : k_names)
        if (n.number == internal_format) return std::string("GL_") + n.name;
    constexpr std::uint32_t k_astc = 0x93b0, k_astc_srgb = 0x93d0;
    if (internal_format >= k_astc && internal_format < k_astc + std::size(k_astc_blocks))
        return std::string("GL_COMPRESSED_RGBA_ASTC_") + k_astc_blocks[internal_format - k_astc];
    if (internal_format >= k_astc_srgb && internal_format < k_astc_srgb + std::size(k_astc_blocks))
        return std::string("GL_COMPRESSED_SRGB8_ALPHA8_ASTC_") + k_astc_blocks[internal_format - k_astc_srgb];
    char text[40];
    std::snprintf(text, sizeof text, "GL internal format 0x%04x", internal_format);
    return text;
}

std::optional<StoredTexels> gl_format_texels(std::uint32_t internal_format, std::uint32_t type) {
    constexpr std::uint32_t k_half = 0x140b, k_half_oes = 0x8d61, k_float = 0x1406;
    const bool half = type == k_half || type == k_half_oes, single = type == k_float;
    // OpenGL converts on upload, so a half format may come with float texels, and the other way round: the type says
    // what is stored.
    switch (internal_format) {
        case k_gl_r11f_g11f_b10f:
            // 0x8c3b is right; Filament writes the internal format.
            if (type == 0x8c3b || type == internal_format) return StoredTexels{Encoding::r11g11b10f};
            [[fallthrough]];
        case k_gl_rgb9_e5:
            if (internal_format == k_gl_rgb9_e5 && type == 0x8c3e) return StoredTexels{Encoding::rgb9e5};
            [[fallthrough]];
        case k_gl_rgb16f:
        case k_gl_rgb32f:
            if (half) return StoredTexels{Encoding::rgba16f, 3, 2};
            if (single) return StoredTexels{Encoding::rgba32f, 3, 4};
            return std::nullopt;
        case k_gl_rgba16f:
        case k_gl_rgba32f:
            if (half) return StoredTexels{Encoding::rgba16f};
            if (single) return StoredTexels{Encoding::rgba32f};
            return std::nullopt;
        case k_gl_rg16f:
        case k_gl_rg32f:
            if (half) return StoredTexels{Encoding::rg16f};
            if (single) return StoredTexels{Encoding::rg32f};
            return std::nullopt;
        case k_gl_r16f:
        case k_gl_r32f:
            if (half) return StoredTexels{Encoding::rg16f, 1, 2};
            if (single) return StoredTexels{Encoding::rg32f, 1, 4};
            return std::nullopt;
        case k_gl_bptc_unsigned_float:
            // Compressed formats have type 0; with any other type OpenGL would compress texels on upload.
            if (type == 0) return StoredTexels{Encoding::bc6h};
            return std::nullopt;
        case k_gl_astc4x4:
            if (type == 0) return StoredTexels{Encoding::astc4x4_hdr};
            return std::nullopt;
        case k_gl_astc6x6:
            if (type == 0) return StoredTexels{Encoding::astc6x6_hdr};
            return std::nullopt;
        default:
            return std::nullopt;
    }
}

std::optional<StatedScreenTexels> gl_format_screen_texels(std::uint32_t internal_format, std::uint32_t format,
                                                          std::uint32_t type) {
    using Kind = ScreenTexels::Kind;
    struct Blocks {
        std::uint32_t linear, srgb;
        Kind kind;
    };
    static constexpr Blocks k_blocks[] = {
        {0x83f0, 0x8c4c, Kind::bc1},  // RGB_S3TC_DXT1
        {0x83f1, 0x8c4d, Kind::bc1},  // RGBA_S3TC_DXT1
        {0x83f2, 0x8c4e, Kind::bc2},  // RGBA_S3TC_DXT3
        {0x83f3, 0x8c4f, Kind::bc3},  // RGBA_S3TC_DXT5
        {0x8e8c, 0x8e8d, Kind::bc7},  // RGBA_BPTC
    };
    for (const Blocks& row : k_blocks)
        if (type == 0 && (internal_format == row.linear || internal_format == row.srgb))
            return StatedScreenTexels{{row.kind, 0, {}}, internal_format == row.srgb};

    struct Order {
        std::uint32_t format;
        ScreenTexels texels;
    };
    static constexpr Order k_orders[] = {
        {0x1907, {Kind::bytes, 3, {0, 1, 2, -1}}},  // GL_RGB
        {0x80e0, {Kind::bytes, 3, {2, 1, 0, -1}}},  // GL_BGR
        {0x1908, {}},                               // GL_RGBA
        {0x80e1, {Kind::bytes, 4, {2, 1, 0, 3}}},   // GL_BGRA
    };
    const bool srgb = internal_format == 0x8c41 || internal_format == 0x8c43;  // SRGB8, SRGB8_ALPHA8
    const bool linear = internal_format == k_gl_rgba8 || internal_format == 0x8051 || internal_format == 0x1907 ||
                        internal_format == 0x1908;  // RGB8, RGB, RGBA
    if (type != k_gl_unsigned_byte || !(srgb || linear)) return std::nullopt;
    for (const Order& row : k_orders)
        if (format == row.format) return StatedScreenTexels{row.texels, srgb};
    return std::nullopt;
}

}  // namespace domelight
