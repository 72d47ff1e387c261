// The numbers of VkFormat (Vulkan 1.3 specification, section 34.1.1, and the extensions that image files use).
#include "texture/container/vulkan_formats.h"

#include "texture/container/ktx2.h"

#include <array>
#include <iterator>

namespace domelight {

namespace {

/// Formats that run through the same list of numeric types: `first` is `components`_`types[0]``tail`, and so on.
struct Family {
    std::uint32_t first;
    const char* components;
    const char* tail;
    int types;  ///< how many, of `list`
    const char* const* list;
};

constexpr const char* k_eight[] = {"UNORM", "SNORM", "USCALED", "SSCALED", "UINT", "SINT", "SRGB"};
constexpr const char* k_sixteen[] = {"UNORM", "SNORM", "USCALED", "SSCALED", "UINT", "SINT", "SFLOAT"};
constexpr const char* k_wide[] = {"UINT", "SINT", "SFLOAT"};
constexpr const char* k_unorm_srgb[] = {"UNORM", "SRGB"};
constexpr const char* k_unorm_snorm[] = {"UNORM", "SNORM"};
constexpr const char* k_float_kinds[] = {"UFLOAT", "SFLOAT"};
constexpr const char* k_sfloat[] = {"SFLOAT"};
constexpr const char* k_unorm[] = {"UNORM"};

template <std::size_t n>
constexpr Family family(std::uint32_t first, const char* components, const char* const (&list)[n],
                        const char* tail = "") {
    return {first, components, tail, int(n), list};
}

constexpr Family k_families[] = {
    family(1, "R4G4", k_unorm, "_PACK8"),
    family(2, "R4G4B4A4", k_unorm, "_PACK16"),
    family(3, "B4G4R4A4", k_unorm, "_PACK16"),
    family(4, "R5G6B5", k_unorm, "_PACK16"),
    family(5, "B5G6R5", k_unorm, "_PACK16"),
    family(6, "R5G5B5A1", k_unorm, "_PACK16"),
    family(7, "B5G5R5A1", k_unorm, "_PACK16"),
    family(8, "A1R5G5B5", k_unorm, "_PACK16"),
    family(9, "R8", k_eight),
    family(16, "R8G8", k_eight),
    family(23, "R8G8B8", k_eight),
    family(30, "B8G8R8", k_eight),
    family(37, "R8G8B8A8", k_eight),
    family(44, "B8G8R8A8", k_eight),
    family(51, "A8B8G8R8", k_eight, "_PACK32"),
    {58, "A2R10G10B10", "_PACK32", 6, k_eight},
    {64, "A2B10G10R10", "_PACK32", 6, k_eight},
    family(70, "R16", k_sixteen),
    family(77, "R16G16", k_sixteen),
    family(84, "R16G16B16", k_sixteen),
    family(91, "R16G16B16A16", k_sixteen),
    family(98, "R32", k_wide),
    family(101, "R32G32", k_wide),
    family(104, "R32G32B32", k_wide),
    family(107, "R32G32B32A32", k_wide),
    family(110, "R64", k_wide),
    family(113, "R64G64", k_wide),
    family(116, "R64G64B64", k_wide),
    family(119, "R64G64B64A64", k_wide),
    {122, "B10G11R11", "_PACK32", 1, k_float_kinds},
    {123, "E5B9G9R9", "_PACK32", 1, k_float_kinds},
    family(124, "D16", k_unorm),
    family(125, "X8_D24", k_unorm, "_PACK32"),
    family(126, "D32", k_sfloat),
    {127, "S8", "", 1, k_wide},
    family(128, "D16", k_unorm, "_S8_UINT"),
    family(129, "D24", k_unorm, "_S8_UINT"),
    family(130, "D32", k_sfloat, "_S8_UINT"),
    family(131, "BC1_RGB", k_unorm_srgb, "_BLOCK"),
    family(133, "BC1_RGBA", k_unorm_srgb, "_BLOCK"),
    family(135, "BC2", k_unorm_srgb, "_BLOCK"),
    family(137, "BC3", k_unorm_srgb, "_BLOCK"),
    family(139, "BC4", k_unorm_snorm, "_BLOCK"),
    family(141, "BC5", k_unorm_snorm, "_BLOCK"),
    family(143, "BC6H", k_float_kinds, "_BLOCK"),
    family(145, "BC7", k_unorm_srgb, "_BLOCK"),
    family(147, "ETC2_R8G8B8", k_unorm_srgb, "_BLOCK"),
    family(149, "ETC2_R8G8B8A1", k_unorm_srgb, "_BLOCK"),
    family(151, "ETC2_R8G8B8A8", k_unorm_srgb, "_BLOCK"),
    family(153, "EAC_R11", k_unorm_snorm, "_BLOCK"),
    family(155, "EAC_R11G11", k_unorm_snorm, "_BLOCK"),
    family(1000340000, "A4R4G4B4", k_unorm, "_PACK16"),
    family(1000340001, "A4B4G4R4", k_unorm, "_PACK16"),
};

constexpr const char* k_astc_blocks[] = {"4x4", "5x4",  "5x5",  "6x5",  "6x6",   "8x5",   "8x6",
                                         "8x8", "10x5", "10x6", "10x8", "10x10", "12x10", "12x12"};
constexpr std::uint32_t k_astc = 157, k_astc_hdr = 1000066000, k_pvrtc = 1000054000, k_astc_3d = 1000288000;
constexpr const char* k_pvrtc_names[] = {"PVRTC1_2BPP_UNORM", "PVRTC1_4BPP_UNORM", "PVRTC2_2BPP_UNORM",
                                         "PVRTC2_4BPP_UNORM", "PVRTC1_2BPP_SRGB",  "PVRTC1_4BPP_SRGB",
                                         "PVRTC2_2BPP_SRGB",  "PVRTC2_4BPP_SRGB"};
constexpr const char* k_astc_3d_blocks[] = {"3x3x3", "4x3x3", "4x4x3", "4x4x4", "5x4x4",
                                            "5x5x4", "5x5x5", "6x5x5", "6x6x5", "6x6x6"};
constexpr const char* k_astc_3d_types[] = {"UNORM", "SRGB", "SFLOAT"};

}  // namespace

std::string vulkan_format_name(std::uint32_t format) {
    const std::string prefix = "VK_FORMAT_";
    for (const Family& f : k_families)
        if (format >= f.first && format < f.first + std::uint32_t(f.types))
            return prefix + f.components + "_" + f.list[format - f.first] + f.tail;
    if (format >= k_astc && format < k_astc + 2 * std::size(k_astc_blocks))
        return prefix + "ASTC_" + k_astc_blocks[(format - k_astc) / 2] +
               ((format - k_astc) % 2 ? "_SRGB_BLOCK" : "_UNORM_BLOCK");
    if (format >= k_astc_hdr && format < k_astc_hdr + std::size(k_astc_blocks))
        return prefix + "ASTC_" + k_astc_blocks[format - k_astc_hdr] + "_SFLOAT_BLOCK";
    if (format >= k_pvrtc && format < k_pvrtc + std::size(k_pvrtc_names))
        return prefix + k_pvrtc_names[format - k_pvrtc] + "_BLOCK_IMG";
    if (format >= k_astc_3d && format < k_astc_3d + 3 * std::size(k_astc_3d_blocks))
        return prefix + "ASTC_" + k_astc_3d_blocks[(format - k_astc_3d) / 3] + "_" +
               k_astc_3d_types[(format - k_astc_3d) % 3] + "_BLOCK_EXT";
    return "VkFormat " + std::to_string(format);
}

std::optional<StoredTexels> vulkan_format_texels(std::uint32_t format) {
    switch (format) {
        case 76:
            return StoredTexels{Encoding::rg16f, 1, 2};  // R16_SFLOAT
        case 83:
            return StoredTexels{Encoding::rg16f};  // R16G16_SFLOAT
        case 90:
            return StoredTexels{Encoding::rgba16f, 3, 2};  // R16G16B16_SFLOAT
        case 97:
            return StoredTexels{Encoding::rgba16f};  // R16G16B16A16_SFLOAT
        case 100:
            return StoredTexels{Encoding::rg32f, 1, 4};  // R32_SFLOAT
        case 103:
            return StoredTexels{Encoding::rg32f};  // R32G32_SFLOAT
        case 106:
            return StoredTexels{Encoding::rgba32f, 3, 4};  // R32G32B32_SFLOAT
        case 109:
            return StoredTexels{Encoding::rgba32f};  // R32G32B32A32_SFLOAT
        case 122:
            return StoredTexels{Encoding::r11g11b10f};  // B10G11R11_UFLOAT_PACK32
        case 123:
            return StoredTexels{Encoding::rgb9e5};  // E5B9G9R9_UFLOAT_PACK32
        case 143:
            return StoredTexels{Encoding::bc6h};  // BC6H_UFLOAT_BLOCK
        case k_vulkan_astc4x4_hdr:
            return StoredTexels{Encoding::astc4x4_hdr};  // ASTC_4x4_SFLOAT_BLOCK
        case k_vulkan_astc6x6_hdr:
            return StoredTexels{Encoding::astc6x6_hdr};  // ASTC_6x6_SFLOAT_BLOCK
        default:
            return std::nullopt;
    }
}

std::optional<StatedScreenTexels> vulkan_format_screen_texels(std::uint32_t format) {
    using Kind = ScreenTexels::Kind;
    struct Row {
        std::uint32_t unorm, srgb;
        ScreenTexels texels;
    };
    static constexpr Row k_rows[] = {
        {23, 29, {Kind::bytes, 3, {0, 1, 2, -1}}},  // R8G8B8
        {30, 36, {Kind::bytes, 3, {2, 1, 0, -1}}},  // B8G8R8
        {37, 43, {}},                               // R8G8B8A8
        {44, 50, {Kind::bytes, 4, {2, 1, 0, 3}}},   // B8G8R8A8
        {51, 57, {}},                               // A8B8G8R8_PACK32: little-endian, so red is the first byte
        {131, 132, {Kind::bc1, 0, {}}},             // BC1_RGB
        {133, 134, {Kind::bc1, 0, {}}},             // BC1_RGBA
        {135, 136, {Kind::bc2, 0, {}}},             // BC2
        {137, 138, {Kind::bc3, 0, {}}},             // BC3
        {145, 146, {Kind::bc7, 0, {}}},             // BC7
    };
    for (const Row& row : k_rows)
        if (format == row.unorm || format == row.srgb) return StatedScreenTexels{row.texels, format == row.srgb};
    return std::nullopt;
}

}  // namespace domelight
