#pragma once
// Constants of the KTX 2.0 container for its reader and writer.

#include "domelight/texture/texture.h"

#include <array>
#include <cstdint>

namespace domelight {

inline constexpr std::array<std::uint8_t, 12> k_ktx2_identifier{0xab, 'K',  'T',  'X',  ' ',  '2',
                                                                '0',  0xbb, '\r', '\n', 0x1a, '\n'};
inline constexpr std::uint64_t k_ktx2_header_bytes = 80, k_ktx2_level_bytes = 24;

inline constexpr std::uint32_t k_vulkan_rgba8 = 37;  // VK_FORMAT_R8G8B8A8_UNORM
/// VkFormat numbers of ASTC HDR (VK_EXT_texture_compression_astc_hdr).
inline constexpr std::uint32_t k_vulkan_astc4x4_hdr = 1000066000, k_vulkan_astc6x6_hdr = 1000066004;
/// The colour model by which a file in the first of these formats states that its blocks are UASTC HDR 4x4.
inline constexpr unsigned k_model_uastc_hdr = 167;

/// VkFormat number of an encoding.
constexpr std::uint32_t vulkan_format(Encoding encoding) {
    switch (encoding) {
        case Encoding::rgba16f:
            return 97;  // VK_FORMAT_R16G16B16A16_SFLOAT
        case Encoding::rgba32f:
            return 109;  // VK_FORMAT_R32G32B32A32_SFLOAT
        case Encoding::rgb9e5:
            return 123;  // VK_FORMAT_E5B9G9R9_UFLOAT_PACK32
        case Encoding::r11g11b10f:
            return 122;  // VK_FORMAT_B10G11R11_UFLOAT_PACK32
        case Encoding::rg16f:
            return 83;  // VK_FORMAT_R16G16_SFLOAT
        case Encoding::r32f:
            return 100;  // VK_FORMAT_R32_SFLOAT
        case Encoding::bc6h:
            return 143;  // VK_FORMAT_BC6H_UFLOAT_BLOCK
        case Encoding::rgbm:
        case Encoding::rgbd:
        case Encoding::rgbp:
            return k_vulkan_rgba8;
        case Encoding::uastc_hdr:
        case Encoding::astc4x4_hdr:
            return k_vulkan_astc4x4_hdr;  // VK_FORMAT_ASTC_4x4_SFLOAT_BLOCK
        case Encoding::astc6x6_hdr:
            return k_vulkan_astc6x6_hdr;  // VK_FORMAT_ASTC_6x6_SFLOAT_BLOCK
        case Encoding::rg32f:
            break;
    }
    return 103;  // VK_FORMAT_R32G32_SFLOAT
}

}  // namespace domelight
