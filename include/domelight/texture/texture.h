#pragma once

#include "domelight/base/large_allocator.h"
#include "domelight/base/names.h"
#include "domelight/base/result.h"
#include "domelight/filtering/prefilter.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace domelight {

/// How texels are stored on the GPU: one by one, or (bc6h, uastc_hdr, astc..._hdr) in blocks. Blocks of uastc_hdr are
/// astc4x4_hdr of a kind that can be turned into bc6h.
enum class Encoding {
    rgba16f,
    rgba32f,
    rgb9e5,
    r11g11b10f,
    rg16f,
    rg32f,
    r32f,
    bc6h,
    rgbm,
    rgbd,
    rgbp,
    uastc_hdr,
    astc4x4_hdr,
    astc6x6_hdr
};
template <>
struct EnumNames<Encoding> {
    static constexpr const char* kind = "an encoding";
    static constexpr NamedValue<Encoding> table[] = {
        {Encoding::rgba16f, "rgba16f"},
        {Encoding::rgba32f, "rgba32f"},
        {Encoding::rgb9e5, "rgb9e5"},
        {Encoding::r11g11b10f, "r11g11b10f"},
        {Encoding::bc6h, "bc6h"},
        {Encoding::uastc_hdr, "uastc-hdr"},
        {Encoding::astc4x4_hdr, "astc4x4-hdr"},
        {Encoding::astc6x6_hdr, "astc6x6-hdr"},
        {Encoding::rgbm, "rgbm"},
        {Encoding::rgbd, "rgbd"},
        {Encoding::rgbp, "rgbp"},
        {Encoding::rg16f, "rg16f"},
        {Encoding::rg32f, "rg32f"},
        {Encoding::r32f, "r32f"},
    };
};

int encoding_block(Encoding encoding);     ///< texels along a side of a block; 1: single texels
int encoding_bytes(Encoding encoding);     ///< of a block
int encoding_channels(Encoding encoding);  ///< that carry data: 3, 2 (red and green) or 1
double encoding_max(Encoding encoding);    ///< largest value a channel can hold

/// The effort of the encodings that search for the best block (bc6h, uastc_hdr, astc4x4_hdr, astc6x6_hdr); the others
/// ignore it. fast: a few candidates. standard: nearly the best quality. high: some tenths of a decibel more.
/// exhaustive: every mode and partition, for comparison.
enum class EncodingQuality { fast, standard, high, exhaustive };
template <>
struct EnumNames<EncodingQuality> {
    static constexpr const char* kind = "a quality";
    static constexpr NamedValue<EncodingQuality> table[] = {
        {EncodingQuality::fast, "fast"},
        {EncodingQuality::standard, "default"},
        {EncodingQuality::high, "high"},
        {EncodingQuality::exhaustive, "exhaustive"},
    };
};

/// The errors of an encoded level.
struct EncodingReport {
    std::int64_t clipped_texels = 0;
    /// The share of the level's power that clipping lost, 0..1: luminance weighted by solid angle.
    double clipped_energy = 0;
    double rms_error = 0;  ///< relative RMS error of the stored values against the float ones, clipped texels left out
    /// PSNR in dB of x = log2(v + 1e-4 m) over all channels, weighted by solid angle, where m is the level's mean
    /// luminance and the peak is the range max(x) - min(x) over the level (values below 0 count as 0); clipped texels
    /// left out. Infinite if nothing was lost.
    double log_psnr = std::numeric_limits<double>::infinity();
};

/// Encoded texels: a byte vector that is not cleared when it is made with a size alone.
using TexelBytes = std::vector<std::uint8_t, LargeAllocator<std::uint8_t>>;

/// A GPU texture in memory. A level holds all faces (cube: 6, +X -X +Y -Y +Z -Z in OpenGL's orientation; otherwise 1)
/// as tightly packed rows of texels or blocks. A width or height that is not a whole number of blocks is rounded up.
struct Texture {
    Encoding encoding = Encoding::rgba16f;
    int width = 0, height = 0;
    int faces = 1;
    std::vector<TexelBytes> levels;               ///< level l: faces one after the other, of face_bytes(l) bytes each
    std::map<std::string, std::string> metadata;  ///< key/value data, UTF-8 without terminator
    int level_width(int l) const { return std::max(1, width >> l); }
    int level_height(int l) const { return std::max(1, height >> l); }
    /// The number of blocks (or of texels, if they are encoded one by one) in a row of a level, and of such rows.
    int level_columns(int l) const { return in_blocks(level_width(l)); }
    int level_rows(int l) const { return in_blocks(level_height(l)); }
    std::size_t face_bytes(int l) const {
        return std::size_t(level_columns(l)) * std::size_t(level_rows(l)) * std::size_t(encoding_bytes(encoding));
    }

  private:
    int in_blocks(int texels) const { return (texels + encoding_block(encoding) - 1) / encoding_block(encoding); }
};

/// Encodes float RGB maps (each level half the size of the one before) as a texture. Values that the encoding cannot
/// hold are clipped and reported, with one report a level. The bytes are the same on any number of threads.
Texture encode_texture(std::span<const FilteredMap> levels, Encoding encoding, int threads,
                       std::vector<EncodingReport>* reports = nullptr,
                       EncodingQuality quality = EncodingQuality::standard);
/// A float image of one to three channels (a BRDF table) as a texture of one level, in an encoding of single texels.
Texture encode_table(ImageView<const float> table, Encoding encoding);
/// Float texels of one face of a level, in as many channels as the encoding has.
ImageF decode_texture(const Texture& texture, int level, int face);

/// All levels of an RGB cube. Errors: not six faces; fewer than three channels.
Result<std::vector<Cubemap>> decode_cubes(const Texture& texture);

enum class Supercompression { none, zstd };

/// Containers. An output appears whole or not at all; an existing file is replaced only by a complete one.
Result<void> write_ktx2(const std::filesystem::path& file, const Texture& texture,
                        Supercompression compression = Supercompression::none);
Result<void> write_ktx1(const std::filesystem::path& file, const Texture& texture);
Result<void> write_dds(const std::filesystem::path& file, const Texture& texture);
/// DDS with the header from before DX10, for tools that read no other: half and float RGBA and RG; rgbm, rgbd and rgbp
/// as RGBA bytes, whose meaning the file cannot state.
Result<void> write_dds9(const std::filesystem::path& file, const Texture& texture);

/// The header of any KTX2, KTX1 or DDS file, including formats whose texels we do not decode.
struct TextureInfo {
    std::string container, format;  ///< "KTX2", "VK_FORMAT_R16G16B16A16_SFLOAT"
    std::string supercompression;   ///< "none", "zstd", ...
    int width = 0, height = 0, depth = 0, faces = 1, layers = 0, levels = 1;
    std::map<std::string, std::string> metadata;
    bool decodable = false;   ///< read_texture can decode it
    bool eight_bits = false;  ///< 8 bits a channel: a picture for a screen, or RGBM and similar
};
Result<TextureInfo> read_texture_info(const std::filesystem::path& file);
/// Reads a texture in one of our encodings, in half R, in half or float RGB, or with a colour of eight bits a channel
/// (also as BC1, BC2, BC3, BC7). R becomes RG with a green of 0 (also r32f, which becomes rg32f), and RGB becomes RGBA
/// with an alpha of 1. Eight bits a channel become half floats, by the curve that the format of a KTX2 or KTX file
/// states; in DDS by that of sRGB. The levels of a KTX2 file may be packed with zstd or zlib. Every size and offset is
/// checked against the file before memory is allocated; a texture that needs more than 2 GiB is refused.
Result<Texture> read_texture(const std::filesystem::path& file);

}  // namespace domelight
