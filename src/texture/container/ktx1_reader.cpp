// Reads KTX 1.1 (Khronos KTX File Format Specification, version 1.1), of either endianness.
#include "texture/container/gl_formats.h"
#include "texture/container/key_values.h"
#include "texture/container/ktx1.h"
#include "texture/container/scaled_bytes.h"
#include "texture/container/texture_reading.h"

#include <algorithm>
#include <bit>
#include <string>

namespace domelight {

namespace {

struct Ktx1 {
    TextureInfo info;
    std::optional<StoredTexels> texels;
    bool swapped = false;  ///< written on a machine of the other endianness
    std::uint32_t type_bytes = 1;
    std::uint64_t data_offset = 0;
};

/// Reads the sizes of the levels: imageSize precedes each, and faces and levels are padded to 4 bytes.
Result<void> check_levels(ByteSource& source, const Ktx1& file) {
    std::uint64_t at = file.data_offset;
    const std::uint64_t faces = file.info.faces == 6 && file.info.layers == 0 ? 6 : 1;
    for (int l = 0; l < file.info.levels; ++l) {
        const auto size = source.take(at, 4, "level's size");
        if (!size) return size.error();
        const std::uint64_t bytes = (std::uint64_t(FileWords{*size, file.swapped}.at(0)) + 3) / 4 * 4 * faces;
        if (bytes == 0) return Error{"level " + std::to_string(l) + " is empty", "", "the file is damaged"};
        if (!source.contains(at + 4, bytes)) {
            return Error{"ends too early: level " + std::to_string(l) + " should take " + std::to_string(bytes) +
                             " bytes from byte " + std::to_string(at + 4) + ", but there are only " +
                             std::to_string(source.size()),
                         "", "the file is truncated or damaged"};
        }
        at += 4 + bytes;
    }
    return {};
}

Result<Ktx1> parse_ktx1(ByteSource& source, Decode decode = Decode::automatic) {
    const auto head = source.take(0, k_ktx1_header_bytes, "header");
    if (!head) return head.error();
    Ktx1 file;
    file.info.container = "KTX";
    file.info.supercompression = "none";
    file.swapped = u32_at(*head, 12) == 0x01020304;
    const FileWords words{*head, file.swapped};
    if (words.at(12) != k_ktx1_endianness)
        return Error{"has a damaged header: its endianness mark is neither of the two", "", "the file is damaged"};
    const auto word = [&](std::size_t i) { return words.at(12 + 4 * i); };
    file.type_bytes = word(2);
    const std::uint32_t internal_format = word(4);
    Result<void> done = set_shape(file.info, word(6), word(7), word(8), word(9), word(10), word(11));
    if (!done) return done.error();
    file.info.format = gl_format_name(internal_format);
    file.texels = gl_format_texels(internal_format, word(1));
    done = read_key_values(source, k_ktx1_header_bytes, word(12), file.swapped, file.info.metadata);
    if (!done) return done.error();
    if (internal_format == k_gl_rgba8 && word(1) == k_gl_unsigned_byte)
        if (const auto encoding = take_scaled_bytes(file.info.metadata)) {
            file.texels = StoredTexels{*encoding};
            file.info.format += ", " + name_of(*encoding);
        }
    const auto screen = gl_format_screen_texels(internal_format, word(3), word(1));
    if (screen && !file.texels) {
        file.texels = stored_screen_texels(*screen, decode);
        file.info.eight_bits = true;
    }
    file.data_offset = k_ktx1_header_bytes + word(12);
    done = check_levels(source, file);
    if (!done) return done.error();
    file.info.decodable = bool(texture_for(file.info, file.texels));
    return file;
}

/// The size of the numbers whose bytes must be swapped: the packed formats are one 32-bit number, whatever type size
/// the header states; blocks are bytes.
std::size_t swap_unit(const StoredTexels& texels) {
    if (texels.screen) return 1;
    if (texels.channels > 0) return std::size_t(texels.channel_bytes);
    if (encoding_block(texels.encoding) > 1 || is_scaled_bytes(texels.encoding)) return 1;
    return texels.encoding == Encoding::rgba16f || texels.encoding == Encoding::rg16f ? 2 : 4;
}

std::uint64_t padded(std::uint64_t row_bytes) {
    return (row_bytes + 3) / 4 * 4;
}

/// One face of level `l`: rows of texels or blocks padded to 4 bytes become tight ones, in our byte order.
void append_face(const Ktx1& file, const Texture& texture, int l, Bytes& stored, Bytes& out) {
    if (file.swapped) {
        const std::size_t unit = swap_unit(*file.texels);
        for (std::size_t i = 0; i + unit <= stored.size(); i += unit)
            std::reverse(stored.begin() + std::ptrdiff_t(i), stored.begin() + std::ptrdiff_t(i + unit));
    }
    const auto tight = std::size_t(stored_row_bytes(texture, *file.texels, l));
    const auto rows = std::size_t(stored_rows(texture, *file.texels, l));
    for (std::size_t y = 0; y < rows; ++y) {
        const auto row = stored.begin() + std::ptrdiff_t(std::size_t(padded(tight)) * y);
        out.insert(out.end(), row, row + std::ptrdiff_t(tight));
    }
}

}  // namespace

Result<TextureInfo> ktx1_info(ByteSource& source) {
    auto file = parse_ktx1(source);
    if (!file) return file.error();
    return std::move(file->info);
}

Result<Texture> ktx1_texture(ByteSource& source, Decode decode) {
    const auto file = parse_ktx1(source, decode);
    if (!file) return file.error();
    auto texture = texture_for(file->info, file->texels);
    if (!texture) return texture;
    std::uint64_t at = file->data_offset;
    for (int l = 0; l < file->info.levels; ++l) {
        const auto size = source.take(at, 4, "level's size");
        if (!size) return size.error();
        std::uint64_t face_bytes = FileWords{*size, file->swapped}.at(0);
        // Some writers count all faces of a cube that is an array of one.
        if (file->info.layers == 1 && file->info.faces == 6) face_bytes /= 6;
        const std::uint64_t needed =
            padded(stored_row_bytes(*texture, *file->texels, l)) * stored_rows(*texture, *file->texels, l);
        if (face_bytes != needed) {
            return Error{"level " + std::to_string(l) + " has " + std::to_string(face_bytes) +
                             " bytes a face, but its size needs " + std::to_string(needed),
                         "", "the file is damaged"};
        }
        at += 4;
        Bytes level;
        level.reserve(std::size_t(stored_level_bytes(*texture, *file->texels, l)));
        for (int face = 0; face < texture->faces; ++face, at += face_bytes) {
            auto stored = source.take(at, face_bytes, "level");
            if (!stored) return stored.error();
            append_face(*file, *texture, l, *stored, level);
        }
        texture->levels.push_back(widen_level(*texture, *file->texels, l, std::move(level)));
    }
    return texture;
}

}  // namespace domelight
