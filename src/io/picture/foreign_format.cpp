#include "io/picture/foreign_format.h"

#include <algorithm>
#include <string_view>

namespace domelight {

namespace {

using namespace std::string_view_literals;

struct Magic {
    std::size_t at;
    std::string_view bytes;
    const char* name;
    const char* hint;
};

constexpr const char* k_to_png = "Convert it to PNG, for example by ImageMagick: magick IN OUT.png.";
constexpr const char* k_tiff =
    "Convert it: of floats to OpenEXR by oiiotool IN -o OUT.exr, otherwise to PNG by magick IN OUT.png.";
constexpr const char* k_avif = "Convert it: avifdec -d 16 IN OUT.png, which keeps PQ and HLG.";
constexpr const char* k_heic = "Convert it: heif-dec IN OUT.png (before libheif 1.19, heif-convert).";
constexpr const char* k_jxl = "Convert it: djxl IN OUT.exr, or OUT.png.";

constexpr Magic k_magics[] = {
    {0, "II*\0"sv, "TIFF", k_tiff},
    {0, "MM\0*"sv, "TIFF", k_tiff},
    {0, "BM"sv, "BMP", k_to_png},
    {0, "GIF8"sv, "GIF", k_to_png},
    {0, "8BPS"sv, "Photoshop", k_to_png},
    {4, "ftypavif"sv, "AVIF", k_avif},
    {4, "ftypavis"sv, "AVIF", k_avif},
    {4, "ftyphei"sv, "HEIC", k_heic},
    {4, "ftyphev"sv, "HEIC", k_heic},
    {4, "ftypmif1"sv, "HEIF", k_heic},
    {0, "\xff\x0a"sv, "JPEG XL", k_jxl},
    {0, "\0\0\0\x0cJXL "sv, "JPEG XL", k_jxl},
    {0, "\0\0\0\x0cjP  "sv, "JPEG 2000", k_to_png},
    {0, "\xabKTX 20"sv, "KTX2", ""},
    {0, "DDS "sv, "DDS", ""},
    {0, "PF\n"sv, "PFM", "Convert it to OpenEXR: oiiotool IN -o OUT.exr."},
};

/// TGA has no mark at its start; newer files have one at their end. Otherwise the header must make sense: the kind of
/// palette, of image, and the bits of a texel.
bool is_tga(std::span<const std::uint8_t> b) {
    constexpr std::string_view footer = "TRUEVISION-XFILE";
    if (b.size() < 18) return false;
    if (b.size() >= 26 && std::equal(footer.begin(), footer.end(), b.end() - 18)) return true;
    const auto any_of = [](int value, std::initializer_list<int> list) { return std::ranges::count(list, value) > 0; };
    const bool sized = (b[12] || b[13]) && (b[14] || b[15]);
    return b[1] <= 1 && any_of(b[2], {1, 2, 3, 9, 10, 11}) && any_of(b[16], {8, 15, 16, 24, 32}) && sized;
}

}  // namespace

std::optional<ForeignFormat> foreign_format(std::span<const std::uint8_t> bytes) {
    for (const Magic& magic : k_magics) {
        if (bytes.size() < magic.at + magic.bytes.size()) continue;
        const auto from = bytes.begin() + std::ptrdiff_t(magic.at);
        if (std::equal(magic.bytes.begin(), magic.bytes.end(), from,
                       [](char a, std::uint8_t b) { return std::uint8_t(a) == b; }))
            return ForeignFormat{magic.name, magic.hint};
    }
    if (is_tga(bytes)) return ForeignFormat{"TGA", k_to_png};
    return std::nullopt;
}

}  // namespace domelight
