// Reading of textures: detects the container, and has what all three containers need.
#include "texture/container/texture_reading.h"

#include "base/utf8.h"
#include "texture/container/env.h"
#include "texture/container/ktx1.h"
#include "texture/container/ktx2.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace domelight {

std::string count_text(const char* name, std::uint64_t value) {
    return std::string(name) + " of " + std::to_string(value);
}

Result<void> set_shape(TextureInfo& info, std::uint64_t width, std::uint64_t height, std::uint64_t depth,
                       std::uint64_t layers, std::uint64_t faces, std::uint64_t levels) {
    const auto bad = [](std::string what) {
        return Error{"the header states " + std::move(what), "", "the file is damaged"};
    };
    if (width == 0) return bad("a width of 0");
    const std::uint64_t longest = std::max({width, height, depth});
    if (longest > k_max_texture_side)
        return bad(std::to_string(width) + " x " + std::to_string(height) + " texels, more than any texture has");
    if (depth > 0 && height == 0) return bad("a depth, but no height");
    if (faces != 1 && faces != 6) return bad(count_text("a number of faces", faces) + ", not 1 or 6");
    if (faces == 6 && width != height)
        return bad("a cube of " + std::to_string(width) + " x " + std::to_string(height) + " texels");
    if (faces == 6 && depth > 1) return bad("a cube with a depth");
    if (layers > k_max_texture_side) return bad(count_text("a number of layers", layers));
    const auto most = std::uint64_t(std::bit_width(longest));
    if (levels > most)
        return bad(std::to_string(levels) + " levels, but its size has no more than " + std::to_string(most));
    info.width = int(width);
    info.height = int(std::max<std::uint64_t>(height, 1));
    info.depth = int(depth);
    info.layers = int(layers);
    info.faces = int(faces);
    info.levels = int(std::max<std::uint64_t>(levels, 1));
    return {};
}

Result<Texture> texture_for(const TextureInfo& info, const std::optional<StoredTexels>& texels) {
    if (!texels)
        return Error{
            "cannot decode " + info.format, "",
            "readable: half and float RGBA, RGB, RG and R, RGB9E5, R11G11B10, BC6H (unsigned), ASTC HDR 4x4 and 6x6, "
            "and eight bits a channel as RGBA, RGB, BC1, BC2, BC3 and BC7"};
    if (info.depth > 1) return Error{"is a three-dimensional texture, which is not supported", "", ""};
    if (info.layers > 1)
        return Error{"is an array of " + std::to_string(info.layers) + " textures, which is not supported", "", ""};
    Texture texture;
    texture.encoding = texels->encoding;
    texture.width = info.width;
    texture.height = info.height;
    texture.faces = info.faces;
    texture.metadata = info.metadata;
    std::uint64_t total = 0;  // at most 21 levels of 6 * 2^40 texels of 16 bytes: no overflow
    for (int l = 0; l < info.levels; ++l) total += std::uint64_t(texture.face_bytes(l)) * std::uint64_t(info.faces);
    if (total > k_max_texture_bytes) {
        return Error{"needs " + std::to_string(total) + " bytes of memory, more than the limit of " +
                         std::to_string(k_max_texture_bytes),
                     "", ""};
    }
    return texture;
}

StoredTexels stored_screen_texels(const StatedScreenTexels& stated, Decode decode) {
    if (decode == Decode::automatic) decode = stated.srgb ? Decode::srgb : Decode::linear;
    StoredTexels texels{screen_encoding(decode)};
    texels.screen = stated.texels;
    texels.decode = decode;
    return texels;
}

std::uint64_t stored_row_bytes(const Texture& texture, const StoredTexels& texels, int l) {
    if (texels.screen) return screen_row_bytes(*texels.screen, texture.level_width(l));
    return std::uint64_t(texture.level_columns(l)) * std::uint64_t(texels.bytes());
}

std::uint64_t stored_rows(const Texture& texture, const StoredTexels& texels, int l) {
    return texels.screen ? screen_rows(*texels.screen, texture.level_height(l)) : std::uint64_t(texture.level_rows(l));
}

std::uint64_t stored_level_bytes(const Texture& texture, const StoredTexels& texels, int l) {
    return stored_row_bytes(texture, texels, l) * stored_rows(texture, texels, l) * std::uint64_t(texture.faces);
}

void widen_texels(const StoredTexels& texels, const std::uint8_t* in, std::size_t count, std::uint8_t* out) {
    const std::size_t stored = std::size_t(texels.bytes()), wide = std::size_t(encoding_bytes(texels.encoding));
    if (texels.channels == 0) {
        std::memcpy(out, in, count * wide);
        return;
    }
    // The missing channels: zeros, and one in the fourth channel.
    std::uint8_t rest[16] = {};
    if (texels.encoding == Encoding::rgba16f) rest[7] = 0x3c;
    if (texels.encoding == Encoding::rgba32f) rest[14] = 0x80, rest[15] = 0x3f;
    for (std::size_t i = 0; i < count; ++i, in += stored, out += wide) {
        std::memcpy(out, in, stored);
        std::memcpy(out + stored, rest + stored, wide - stored);
    }
}

Bytes widen_level(const Texture& texture, const StoredTexels& texels, int l, Bytes stored) {
    if (texels.screen) {
        Bytes level(texture.face_bytes(l) * std::size_t(texture.faces));
        const std::size_t face_bytes = stored.size() / std::size_t(texture.faces);
        for (std::size_t face = 0; face < std::size_t(texture.faces); ++face)
            decode_screen_texels(*texels.screen, texels.decode, stored.data() + face * face_bytes,
                                 texture.level_width(l), texture.level_height(l),
                                 level.data() + face * texture.face_bytes(l));
        return level;
    }
    if (texels.channels == 0) return stored;
    const std::size_t count = stored.size() / std::size_t(texels.bytes());
    Bytes wide(count * std::size_t(encoding_bytes(texels.encoding)));
    widen_texels(texels, stored.data(), count, wide.data());
    return wide;
}

bool is_utf8_text(std::span<const std::uint8_t> bytes) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    while (!text.empty()) {
        const Utf8Character c = first_utf8_character(text);
        if (!c.valid || (c.code < 0x20 && c.code != '\t' && c.code != '\n' && c.code != '\r')) return false;
        text.remove_prefix(c.bytes);
    }
    return true;
}

std::string metadata_text(std::span<const std::uint8_t> value) {
    std::span<const std::uint8_t> text = value;
    if (!text.empty() && text.back() == 0) text = text.first(text.size() - 1);
    if (is_utf8_text(text)) return {text.begin(), text.end()};
    static constexpr char k_digits[] = "0123456789abcdef";
    std::string hex = "hex:";
    for (std::uint8_t byte : value) {
        hex += k_digits[byte >> 4];
        hex += k_digits[byte & 15];
    }
    return hex;
}

namespace {

enum class Format { ktx2, ktx1, dds, env };

Result<Format> recognise(ByteSource& source) {
    std::uint8_t head[12] = {};
    const std::size_t count = std::size_t(std::min<std::uint64_t>(source.size(), sizeof head));
    Result<void> done = source.read(0, std::span(head).first(count), "identifier");
    if (!done) return done.error();
    if (std::equal(k_ktx2_identifier.begin(), k_ktx2_identifier.end(), head)) return Format::ktx2;
    if (std::equal(k_ktx1_identifier.begin(), k_ktx1_identifier.end(), head)) return Format::ktx1;
    if (std::memcmp(head, "DDS ", 4) == 0) return Format::dds;
    if (std::equal(k_env_magic.begin(), k_env_magic.end(), head)) return Format::env;
    return Error{"is not a KTX2, KTX, DDS or Babylon .env texture", "", ""};
}

template <typename Read>
auto read_from(const std::filesystem::path& file, Read read) -> decltype(read(std::declval<ByteSource&>())) {
    Result<FileSource> source = FileSource::open(file);
    if (!source) return source.error();
    auto result = read(*source);
    if (!result) return result.error().at(file.string());
    return result;
}

}  // namespace

Result<TextureInfo> texture_info(ByteSource& source) {
    const Result<Format> format = recognise(source);
    if (!format) return format.error();
    switch (*format) {
        case Format::ktx2:
            return ktx2_info(source);
        case Format::ktx1:
            return ktx1_info(source);
        case Format::dds:
            return dds_info(source);
        case Format::env:
            break;
    }
    return env_info(source);
}

Result<Texture> texture(ByteSource& source, Decode decode) {
    const Result<Format> format = recognise(source);
    if (!format) return format.error();
    switch (*format) {
        case Format::ktx2:
            return ktx2_texture(source, decode);
        case Format::ktx1:
            return ktx1_texture(source, decode);
        case Format::dds:
            return dds_texture(source, decode);
        case Format::env:
            break;
    }
    auto env = env_file(source);
    if (!env) return env.error();
    return std::move(env->cube);
}

Result<TextureInfo> read_texture_info(const std::filesystem::path& file) {
    return read_from(file, [](ByteSource& source) { return texture_info(source); });
}

Result<Texture> read_texture(const std::filesystem::path& file) {
    return read_texture(file, Decode::automatic);
}

Result<Texture> read_texture(const std::filesystem::path& file, Decode decode) {
    return read_from(file, [&](ByteSource& source) { return texture(source, decode); });
}

}  // namespace domelight
