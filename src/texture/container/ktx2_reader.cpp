// Reads KTX 2.0 (Khronos KTX File Format Specification, version 2.0).
#include "texture/container/key_values.h"
#include "texture/container/ktx2.h"
#include "texture/container/scaled_bytes.h"
#include "texture/container/texture_reading.h"
#include "texture/container/vulkan_formats.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>

namespace domelight {

namespace {

struct Level {
    std::uint64_t offset, bytes, uncompressed_bytes;
};

/// A parsed file without its texels.
struct Ktx2 {
    TextureInfo info;
    std::uint32_t scheme = 0;
    std::optional<StoredTexels> texels;
    std::vector<Level> levels;
};

/// Numbers of the supercompression schemes that can be undone, besides 0 for none.
constexpr std::uint32_t k_zstd = 2, k_zlib = 3;

std::string scheme_name(std::uint32_t scheme) {
    switch (scheme) {
        case 0:
            return "none";
        case 1:
            return "BasisLZ";
        case k_zstd:
            return "zstd";
        case k_zlib:
            return "zlib";
        default:
            return "scheme " + std::to_string(scheme);
    }
}

bool is_readable(std::uint32_t scheme) {
    return scheme == 0 || scheme == k_zstd || scheme == k_zlib;
}

/// The colour models that files without a Vulkan format use (Khronos Data Format Specification, section 5.6).
std::string model_name(unsigned model) {
    switch (model) {
        case 163:
            return "ETC1S";
        case 166:
            return "UASTC";
        case 167:
            return "UASTC HDR";
        default:
            return "colour model " + std::to_string(model);
    }
}

/// What the first, basic, block of a data format descriptor states.
struct Descriptor {
    unsigned model = 0;
    bool srgb = false;  ///< the transfer function (section 5.8: 2)
};

/// Checks the data format descriptor's own sizes.
Result<Descriptor> read_descriptor(ByteSource& source, std::uint64_t offset, std::uint64_t bytes) {
    if (bytes < 4 + 24 || bytes > 65536)
        return Error{"has a data format descriptor of " + std::to_string(bytes) + " bytes", "", "the file is damaged"};
    const auto data = source.take(offset, bytes, "data format descriptor");
    if (!data) return data.error();
    const unsigned block = u32_at(*data, 8) >> 16;
    if (u32_at(*data, 0) != bytes || block < 24 || block > bytes - 4 || (block - 24) % 16)
        return Error{"has a data format descriptor that contradicts its own size", "", "the file is damaged"};
    return Descriptor{(*data)[12], (*data)[14] == 2};
}

/// Whether a level's stated sizes are those that its texels need.
Result<void> check_level_size(const Ktx2& file, const Texture& texture, int l) {
    const Level& level = file.levels[std::size_t(l)];
    const std::uint64_t needed = stored_level_bytes(texture, *file.texels, l);
    if (level.uncompressed_bytes == needed && (file.scheme != 0 || level.bytes == needed)) return {};
    return Error{"level " + std::to_string(l) + " has " +
                     std::to_string(file.scheme == 0 ? level.bytes : level.uncompressed_bytes) +
                     " bytes, but its size needs " + std::to_string(needed),
                 "", "the file is damaged"};
}

/// The layout of texels of eight bits a channel, whose curve either the format or the descriptor states as sRGB.
std::optional<StatedScreenTexels> screen_texels(std::uint32_t format, const Descriptor& descriptor) {
    auto stated = vulkan_format_screen_texels(format);
    if (stated) stated->srgb = stated->srgb || descriptor.srgb;
    return stated;
}

Result<Ktx2> parse_ktx2(ByteSource& source, Decode decode = Decode::automatic) {
    const auto head = source.take(0, k_ktx2_header_bytes, "header");
    if (!head) return head.error();
    const auto word = [&](int i) { return u32_at(*head, 12 + 4 * std::size_t(i)); };
    Ktx2 file;
    file.info.container = "KTX2";
    const std::uint32_t format = word(0), level_count = word(7);
    Result<void> done = set_shape(file.info, word(2), word(3), word(4), word(5), word(6), level_count);
    if (!done) return done.error();
    file.scheme = word(8);
    file.info.supercompression = scheme_name(file.scheme);

    const auto descriptor = read_descriptor(source, word(9), word(10));
    if (!descriptor) return descriptor.error();
    file.info.format = format ? vulkan_format_name(format) : model_name(descriptor->model);
    file.texels = vulkan_format_texels(format);
    if (format == k_vulkan_astc4x4_hdr && descriptor->model == k_model_uastc_hdr)
        file.texels = StoredTexels{Encoding::uastc_hdr};
    if (word(12) > 0) {
        done = read_key_values(source, word(11), word(12), false, file.info.metadata);
        if (!done) return done.error();
    }
    if (format == k_vulkan_rgba8)
        if (const auto encoding = take_scaled_bytes(file.info.metadata)) {
            file.texels = StoredTexels{*encoding};
            file.info.format += ", " + name_of(*encoding);
        }
    if (const auto screen = screen_texels(format, *descriptor); screen && !file.texels) {
        file.texels = stored_screen_texels(*screen, decode);
        file.info.eight_bits = true;
        if (screen->srgb && !vulkan_format_screen_texels(format)->srgb) file.info.format += ", SRGB by its descriptor";
    }
    if (!source.contains(u64_at(*head, 64), u64_at(*head, 72)))
        return Error{"ends before its supercompression global data", "", "the file is truncated or damaged"};

    const auto index =
        source.take(k_ktx2_header_bytes, k_ktx2_level_bytes * std::uint64_t(file.info.levels), "level index");
    if (!index) return index.error();
    for (int l = 0; l < file.info.levels; ++l) {
        const std::size_t at = std::size_t(k_ktx2_level_bytes) * std::size_t(l);
        const Level level{u64_at(*index, at), u64_at(*index, at + 8), u64_at(*index, at + 16)};
        if (!source.contains(level.offset, level.bytes)) {
            return Error{"ends too early: level " + std::to_string(l) + " should take " + std::to_string(level.bytes) +
                             " bytes from byte " + std::to_string(level.offset) + ", but there are only " +
                             std::to_string(source.size()),
                         "", "the file is truncated or damaged"};
        }
        if (level.bytes == 0) return Error{"level " + std::to_string(l) + " is empty", "", "the file is damaged"};
        file.levels.push_back(level);
    }
    const auto texture = texture_for(file.info, file.texels);
    file.info.decodable = is_readable(file.scheme) && texture;
    for (int l = 0; file.info.decodable && l < file.info.levels; ++l)
        file.info.decodable = bool(check_level_size(file, *texture, l));
    return file;
}

/// Zstandard cannot compress more than 128 KiB into a block of 4 bytes, and deflate no more than 1032 bytes into one.
/// So a header that states more is wrong, and no memory is allocated for it.
constexpr std::uint64_t k_zstd_max_ratio = 32768, k_zlib_max_ratio = 1032;

Result<Bytes> undo_zlib(std::span<const std::uint8_t> packed, std::uint64_t bytes) {
    if (bytes / k_zlib_max_ratio > packed.size())
        return Error{"is packed into fewer bytes than its size can need", "", "the file is damaged"};
    Bytes out(static_cast<std::size_t>(bytes));
    uLongf written = out.size();
    uLong used = packed.size();
    const int code = uncompress2(out.data(), &written, packed.data(), &used);
    if (code == Z_DATA_ERROR) return Error{"is not zlib data", "", "the file is damaged"};
    if (code != Z_OK || written != bytes)
        return Error{"holds another number of bytes than its size needs", "", "the file is damaged"};
    return out;
}

Result<Bytes> undo_zstd(std::span<const std::uint8_t> packed, std::uint64_t bytes) {
    const unsigned long long stated = ZSTD_getFrameContentSize(packed.data(), packed.size());
    if (stated == ZSTD_CONTENTSIZE_ERROR) return Error{"is not zstd data", "", "the file is damaged"};
    if (stated != ZSTD_CONTENTSIZE_UNKNOWN && stated != bytes)
        return Error{"holds another number of bytes than its size needs", "", "the file is damaged"};
    if (bytes / k_zstd_max_ratio > packed.size())
        return Error{"is packed into fewer bytes than its size can need", "", "the file is damaged"};
    Bytes out(static_cast<std::size_t>(bytes));
    const std::size_t n = ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size());
    if (ZSTD_isError(n)) return Error{std::string("zstd: ") + ZSTD_getErrorName(n), "", "the file is damaged"};
    if (n != bytes) return Error{"holds another number of bytes than its size needs", "", "the file is damaged"};
    return out;
}

}  // namespace

Result<TextureInfo> ktx2_info(ByteSource& source) {
    auto file = parse_ktx2(source);
    if (!file) return file.error();
    return std::move(file->info);
}

Result<Texture> ktx2_texture(ByteSource& source, Decode decode) {
    const auto file = parse_ktx2(source, decode);
    if (!file) return file.error();
    auto texture = texture_for(file->info, file->texels);
    if (!texture) return texture;
    if (!is_readable(file->scheme))
        return Error{"cannot undo supercompression " + file->info.supercompression, "", "readable: none, zstd, zlib"};
    for (int l = 0; l < file->info.levels; ++l) {
        const Level& level = file->levels[std::size_t(l)];
        const std::uint64_t bytes = stored_level_bytes(*texture, *file->texels, l);
        const auto at_level = [&](const Error& e) {
            return Error{"level " + std::to_string(l) + " " + e.what, "", e.hint};
        };
        if (const auto sized = check_level_size(*file, *texture, l); !sized) return sized.error();
        auto stored = source.take(level.offset, level.bytes, "level");
        if (!stored) return stored.error();
        if (file->scheme != 0) {
            stored = file->scheme == k_zstd ? undo_zstd(*stored, bytes) : undo_zlib(*stored, bytes);
            if (!stored) return at_level(stored.error());
        }
        texture->levels.push_back(widen_level(*texture, *file->texels, l, *std::move(stored)));
    }
    return texture;
}

}  // namespace domelight
