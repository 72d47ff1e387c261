// DXGI_FORMAT numbers (Direct3D documentation, dxgiformat.h) and the formats of DDS files older than them.
#include "texture/container/dds_formats.h"

#include <array>
#include <cstring>
#include <iterator>

namespace domelight {

namespace {

struct Dxgi {
    const char* name;
    int bits;  ///< of a texel, or of a block of 4 x 4 if negative; 0: planar video and the like
};

/// By number, from 0.
constexpr Dxgi k_dxgi[] = {
    {"UNKNOWN", 0},
    {"R32G32B32A32_TYPELESS", 128},
    {"R32G32B32A32_FLOAT", 128},
    {"R32G32B32A32_UINT", 128},
    {"R32G32B32A32_SINT", 128},
    {"R32G32B32_TYPELESS", 96},
    {"R32G32B32_FLOAT", 96},
    {"R32G32B32_UINT", 96},
    {"R32G32B32_SINT", 96},
    {"R16G16B16A16_TYPELESS", 64},
    {"R16G16B16A16_FLOAT", 64},
    {"R16G16B16A16_UNORM", 64},
    {"R16G16B16A16_UINT", 64},
    {"R16G16B16A16_SNORM", 64},
    {"R16G16B16A16_SINT", 64},
    {"R32G32_TYPELESS", 64},
    {"R32G32_FLOAT", 64},
    {"R32G32_UINT", 64},
    {"R32G32_SINT", 64},
    {"R32G8X24_TYPELESS", 64},
    {"D32_FLOAT_S8X24_UINT", 64},
    {"R32_FLOAT_X8X24_TYPELESS", 64},
    {"X32_TYPELESS_G8X24_UINT", 64},
    {"R10G10B10A2_TYPELESS", 32},
    {"R10G10B10A2_UNORM", 32},
    {"R10G10B10A2_UINT", 32},
    {"R11G11B10_FLOAT", 32},
    {"R8G8B8A8_TYPELESS", 32},
    {"R8G8B8A8_UNORM", 32},
    {"R8G8B8A8_UNORM_SRGB", 32},
    {"R8G8B8A8_UINT", 32},
    {"R8G8B8A8_SNORM", 32},
    {"R8G8B8A8_SINT", 32},
    {"R16G16_TYPELESS", 32},
    {"R16G16_FLOAT", 32},
    {"R16G16_UNORM", 32},
    {"R16G16_UINT", 32},
    {"R16G16_SNORM", 32},
    {"R16G16_SINT", 32},
    {"R32_TYPELESS", 32},
    {"D32_FLOAT", 32},
    {"R32_FLOAT", 32},
    {"R32_UINT", 32},
    {"R32_SINT", 32},
    {"R24G8_TYPELESS", 32},
    {"D24_UNORM_S8_UINT", 32},
    {"R24_UNORM_X8_TYPELESS", 32},
    {"X24_TYPELESS_G8_UINT", 32},
    {"R8G8_TYPELESS", 16},
    {"R8G8_UNORM", 16},
    {"R8G8_UINT", 16},
    {"R8G8_SNORM", 16},
    {"R8G8_SINT", 16},
    {"R16_TYPELESS", 16},
    {"R16_FLOAT", 16},
    {"D16_UNORM", 16},
    {"R16_UNORM", 16},
    {"R16_UINT", 16},
    {"R16_SNORM", 16},
    {"R16_SINT", 16},
    {"R8_TYPELESS", 8},
    {"R8_UNORM", 8},
    {"R8_UINT", 8},
    {"R8_SNORM", 8},
    {"R8_SINT", 8},
    {"A8_UNORM", 8},
    {"R1_UNORM", 0},
    {"R9G9B9E5_SHAREDEXP", 32},
    {"R8G8_B8G8_UNORM", 0},
    {"G8R8_G8B8_UNORM", 0},
    {"BC1_TYPELESS", -64},
    {"BC1_UNORM", -64},
    {"BC1_UNORM_SRGB", -64},
    {"BC2_TYPELESS", -128},
    {"BC2_UNORM", -128},
    {"BC2_UNORM_SRGB", -128},
    {"BC3_TYPELESS", -128},
    {"BC3_UNORM", -128},
    {"BC3_UNORM_SRGB", -128},
    {"BC4_TYPELESS", -64},
    {"BC4_UNORM", -64},
    {"BC4_SNORM", -64},
    {"BC5_TYPELESS", -128},
    {"BC5_UNORM", -128},
    {"BC5_SNORM", -128},
    {"B5G6R5_UNORM", 16},
    {"B5G5R5A1_UNORM", 16},
    {"B8G8R8A8_UNORM", 32},
    {"B8G8R8X8_UNORM", 32},
    {"R10G10B10_XR_BIAS_A2_UNORM", 32},
    {"B8G8R8A8_TYPELESS", 32},
    {"B8G8R8A8_UNORM_SRGB", 32},
    {"B8G8R8X8_TYPELESS", 32},
    {"B8G8R8X8_UNORM_SRGB", 32},
    {"BC6H_TYPELESS", -128},
    {"BC6H_UF16", -128},
    {"BC6H_SF16", -128},
    {"BC7_TYPELESS", -128},
    {"BC7_UNORM", -128},
    {"BC7_UNORM_SRGB", -128},
    {"AYUV", 32},
    {"Y410", 32},
    {"Y416", 64},
    {"NV12", 0},
    {"P010", 0},
    {"P016", 0},
    {"420_OPAQUE", 0},
    {"YUY2", 0},
    {"Y210", 0},
    {"Y216", 0},
    {"NV11", 0},
    {"AI44", 8},
    {"IA44", 8},
    {"P8", 8},
    {"A8P8", 16},
    {"B4G4R4A4_UNORM", 16},
};
static_assert(std::size(k_dxgi) == 116);

std::optional<StoredTexels> dxgi_texels(std::uint32_t number) {
    switch (number) {
        case 2:
            return StoredTexels{Encoding::rgba32f};
        case 6:
            return StoredTexels{Encoding::rgba32f, 3, 4};
        case 10:
            return StoredTexels{Encoding::rgba16f};
        case 16:
            return StoredTexels{Encoding::rg32f};
        case 26:
            return StoredTexels{Encoding::r11g11b10f};
        case 34:
            return StoredTexels{Encoding::rg16f};
        case 41:
            return StoredTexels{Encoding::rg32f, 1, 4};
        case 54:
            return StoredTexels{Encoding::rg16f, 1, 2};
        case 67:
            return StoredTexels{Encoding::rgb9e5};
        case 95:
            return StoredTexels{Encoding::bc6h};
        default:
            return std::nullopt;
    }
}

std::optional<ScreenTexels> dxgi_screen_texels(std::uint32_t number) {
    using Kind = ScreenTexels::Kind;
    switch (number) {
        case 28:  // RGBA, and as sRGB
        case 29:
            return ScreenTexels{};
        case 87:  // BGRA
        case 91:
            return ScreenTexels{Kind::bytes, 4, {2, 1, 0, 3}};
        case 88:  // BGRX
        case 93:
            return ScreenTexels{Kind::bytes, 4, {2, 1, 0, -1}};
        case 71:
        case 72:
            return ScreenTexels{Kind::bc1, 0, {}};
        case 74:
        case 75:
            return ScreenTexels{Kind::bc2, 0, {}};
        case 77:
        case 78:
            return ScreenTexels{Kind::bc3, 0, {}};
        case 98:
        case 99:
            return ScreenTexels{Kind::bc7, 0, {}};
        default:
            return std::nullopt;
    }
}

/// Where channel masks are whole bytes: which byte each one is.
std::optional<ScreenTexels> masked_screen_texels(bool luminance, bool alpha, std::uint32_t bits,
                                                 const std::uint32_t (&masks)[4]) {
    if (bits % 8 || bits < 8) return std::nullopt;
    ScreenTexels texels{ScreenTexels::Kind::bytes, int(bits / 8), {}};
    for (std::size_t c = 0; c < 4; ++c) {
        const std::uint32_t mask = masks[luminance && c < 3 ? 0 : c];
        texels.channel[c] = -1;
        if (c == 3 && (!alpha || mask == 0)) continue;
        for (int byte = 0; byte < texels.bytes; ++byte)
            if (mask == 0xffu << 8 * byte) texels.channel[c] = byte;
        if (texels.channel[c] < 0) return std::nullopt;
    }
    return texels;
}

constexpr std::uint32_t four_characters(const char (&s)[5]) {
    return std::uint32_t(s[0]) | std::uint32_t(s[1]) << 8 | std::uint32_t(s[2]) << 16 | std::uint32_t(s[3]) << 24;
}

/// Printable ones as text, others as a number.
std::string four_character_name(std::uint32_t code) {
    std::string text;
    for (int i = 0; i < 4; ++i) {
        const char c = char(code >> 8 * i & 255u);
        if (c < 0x20 || c > 0x7e) return "D3DFORMAT " + std::to_string(code);
        text += c;
    }
    return text;
}

DdsFormat coded_format(std::uint32_t code) {
    const std::string name = four_character_name(code);
    switch (code) {
        case four_characters("DXT1"):
            return {name, 4, 64, {}, dxgi_screen_texels(71)};
        case four_characters("DXT2"):
        case four_characters("DXT3"):
            return {name, 4, 128, {}, dxgi_screen_texels(74)};
        case four_characters("DXT4"):
        case four_characters("DXT5"):
            return {name, 4, 128, {}, dxgi_screen_texels(77)};
        case four_characters("ATI1"):
        case four_characters("BC4U"):
        case four_characters("BC4S"):
            return {name, 4, 64, {}};
        case four_characters("ATI2"):
        case four_characters("BC5U"):
        case four_characters("BC5S"):
            return {name, 4, 128, {}};
        case 36:
            return {"D3DFMT_A16B16G16R16", 1, 64, {}};
        case 110:
            return {"D3DFMT_Q16W16V16U16", 1, 64, {}};
        case 111:
            return {"D3DFMT_R16F", 1, 16, dxgi_texels(54)};
        case 112:
            return {"D3DFMT_G16R16F", 1, 32, dxgi_texels(34)};
        case 113:
            return {"D3DFMT_A16B16G16R16F", 1, 64, dxgi_texels(10)};
        case 114:
            return {"D3DFMT_R32F", 1, 32, dxgi_texels(41)};
        case 115:
            return {"D3DFMT_G32R32F", 1, 64, dxgi_texels(16)};
        case 116:
            return {"D3DFMT_A32B32G32R32F", 1, 128, dxgi_texels(2)};
        default:
            return {name, 1, 0, {}};
    }
}

}  // namespace

DdsFormat dxgi_format(std::uint32_t number) {
    if (number >= std::size(k_dxgi)) return {"DXGI_FORMAT " + std::to_string(number), 1, 0, {}};
    const Dxgi& facts = k_dxgi[number];
    return {std::string("DXGI_FORMAT_") + facts.name, facts.bits < 0 ? 4 : 1, facts.bits < 0 ? -facts.bits : facts.bits,
            dxgi_texels(number), dxgi_screen_texels(number)};
}

std::uint32_t d3d_number(Encoding encoding) {
    switch (encoding) {
        case Encoding::rg16f:
            return 112;
        case Encoding::rgba16f:
            return 113;
        case Encoding::r32f:
            return 114;
        case Encoding::rg32f:
            return 115;
        case Encoding::rgba32f:
            return 116;
        default:
            return 0;
    }
}

std::uint32_t dxgi_number(Encoding encoding) {
    switch (encoding) {
        case Encoding::rgba16f:
            return 10;
        case Encoding::rgba32f:
            return 2;
        case Encoding::rgb9e5:
            return 67;
        case Encoding::r11g11b10f:
            return 26;
        case Encoding::rg16f:
            return 34;
        case Encoding::r32f:
            return 41;
        case Encoding::bc6h:
            return 95;
        case Encoding::rgbm:
        case Encoding::rgbd:
        case Encoding::rgbp:
            return 28;  // four bytes, whose meaning DDS cannot state
        case Encoding::uastc_hdr:
        case Encoding::astc4x4_hdr:
        case Encoding::astc6x6_hdr:
            return 0;
        case Encoding::rg32f:
            break;
    }
    return 16;
}

DdsFormat legacy_dds_format(std::uint32_t flags, std::uint32_t four_cc, std::uint32_t bits,
                            const std::uint32_t (&masks)[4]) {
    constexpr std::uint32_t k_alpha_pixels = 0x1, k_alpha = 0x2, k_four_cc = 0x4, k_rgb = 0x40, k_luminance = 0x20000;
    if (flags & k_four_cc) return coded_format(four_cc);
    if (!(flags & (k_alpha | k_rgb | k_luminance)) || bits == 0 || bits > 32 || bits % 8)
        return {"an unknown format", 1, 0, {}};
    // Channels in the order of their bits: "BGRA8".
    const bool luminance = flags & k_luminance, has_colour = flags & (k_rgb | k_luminance);
    std::string name;
    for (unsigned bit = 0; bit < 32; ++bit) {
        const auto starts = [&](std::uint32_t mask) {
            return mask >> bit & 1u && (bit == 0 || !(mask >> (bit - 1) & 1u));
        };
        if (has_colour && starts(masks[0])) name += luminance ? 'L' : 'R';
        if (has_colour && !luminance && starts(masks[1])) name += 'G';
        if (has_colour && !luminance && starts(masks[2])) name += 'B';
        if (flags & (k_alpha_pixels | k_alpha) && starts(masks[3])) name += 'A';
    }
    std::optional<ScreenTexels> screen;
    if (has_colour) screen = masked_screen_texels(luminance, flags & k_alpha_pixels, bits, masks);
    return {name + " " + std::to_string(bits) + " bit", 1, int(bits), {}, screen};
}

}  // namespace domelight
