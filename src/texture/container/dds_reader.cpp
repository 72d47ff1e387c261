// Reads DDS, with or without a DX10 header.
#include "texture/container/dds.h"
#include "texture/container/dds_formats.h"
#include "texture/container/texture_reading.h"

#include <algorithm>
#include <bit>
#include <string>

namespace domelight {

namespace {

struct Dds {
    TextureInfo info;
    DdsFormat format;
    std::uint64_t data_offset = 0;
};

/// Bytes of one image of a level, rounded up to whole blocks. At most 2^60: sides are below 2^20 + 4, depth is checked
/// apart.
std::uint64_t image_bytes(const Dds& file, int level) {
    const auto blocks = [&](int side) {
        return std::uint64_t(std::max(1, side >> level) + file.format.block - 1) / std::uint64_t(file.format.block);
    };
    return blocks(file.info.width) * blocks(file.info.height) * std::uint64_t(file.format.block_bits) / 8;
}

/// The file must hold all levels of all images, where their size is known.
Result<void> check_size(ByteSource& source, const Dds& file) {
    if (file.format.block_bits == 0) return {};
    const std::uint64_t images = std::uint64_t(file.info.faces) * std::uint64_t(std::max(1, file.info.layers));
    const Error truncated{"ends too early: " + std::to_string(file.info.width) + " x " +
                              std::to_string(file.info.height) + " texels of " + file.format.name +
                              " do not fit into " + std::to_string(source.size()) + " bytes",
                          "", "the file is truncated or damaged"};
    std::uint64_t needed = 0;
    for (int l = 0; l < file.info.levels; ++l) {
        // Every factor is compared with the file before it is multiplied, so nothing overflows.
        const std::uint64_t one = image_bytes(file, l),
                            slices = images * std::uint64_t(std::max(1, file.info.depth >> l));
        if (one > source.size() || slices > source.size() / std::max<std::uint64_t>(one, 1)) return truncated;
        needed += one * slices;
        if (!source.contains(file.data_offset, needed)) return truncated;
    }
    return {};
}

/// Direct3D 9 lets a cube have some of its faces only: an environment needs all.
Error partial_cube(std::uint32_t caps2) {
    std::string missing;
    constexpr const char* k_names[] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};
    for (int f = 0; f < 6; ++f)
        if (!(caps2 >> (10 + f) & 1u)) missing.append(" ").append(k_names[f]);
    return {"is a cube of " + std::to_string(std::popcount(caps2 & k_ddscaps2_all_faces)) + " faces, not 6", "",
            "It lacks" + missing + "."};
}

Result<Dds> parse(ByteSource& source) {
    const auto head = source.take(0, k_dds_header_bytes, "header");
    if (!head) return head.error();
    const auto word = [&](std::size_t at) { return u32_at(*head, at); };
    // Some writers leave the size of the pixel format out.
    if (word(4) != 124 || (word(76) != 32 && word(76) != 0))
        return Error{"has a damaged header: the sizes of its parts are wrong", "", "the file is damaged"};
    Dds file;
    file.info.container = "DDS";
    file.info.supercompression = "none";
    file.data_offset = k_dds_header_bytes;
    const std::uint32_t flags = word(8), caps2 = word(112), four_cc = word(84);
    const bool dx10 = word(80) & k_ddpf_four_cc && four_cc == k_dds_dx10;
    // Some writers omit the flag, but none the number.
    std::uint64_t levels = word(28), depth = caps2 & k_ddscaps2_volume && flags & k_ddsd_depth ? word(24) : 0,
                  layers = 0, faces = 1, height = word(12);
    if (dx10) {
        const auto more = source.take(k_dds_header_bytes, k_dds_dx10_bytes, "DX10 header");
        if (!more) return more.error();
        file.data_offset += k_dds_dx10_bytes;
        file.format = dxgi_format(u32_at(*more, 0));
        const std::uint32_t dimension = u32_at(*more, 4), array_size = u32_at(*more, 12);
        if (u32_at(*more, 8) & k_dx10_misc_cube) {
            if (dimension != k_dx10_dimension_2d)
                return Error{"states a cube that is not made of two-dimensional images", "", "the file is damaged"};
            faces = 6;
        }
        if (dimension < k_dx10_dimension_1d || dimension > k_dx10_dimension_3d)
            return Error{"states " + count_text("a resource dimension", dimension), "", "the file is damaged"};
        if (dimension == k_dx10_dimension_1d && height > 1)
            return Error{"states a height for a one-dimensional texture", "", "the file is damaged"};
        if (dimension == k_dx10_dimension_3d && array_size > 1)
            return Error{"states an array of three-dimensional textures", "", "the file is damaged"};
        depth = dimension == k_dx10_dimension_3d ? std::max<std::uint64_t>(word(24), 1) : 0;
        layers = array_size > 1 ? array_size : 0;
    } else {
        const std::uint32_t masks[4] = {word(92), word(96), word(100), word(104)};
        file.format = legacy_dds_format(word(80), four_cc, word(88), masks);
        if (caps2 & k_ddscaps2_cube_map) {
            if (depth > 0) return Error{"states a cube that is also a volume", "", "the file is damaged"};
            if ((caps2 & k_ddscaps2_all_faces) != k_ddscaps2_all_faces) return partial_cube(caps2);
            faces = 6;
        }
    }
    Result<void> done = set_shape(file.info, word(16), height, depth, layers, faces, levels);
    if (!done) return done.error();
    file.info.format = file.format.name;
    done = check_size(source, file);
    if (!done) return done.error();
    file.info.eight_bits = bool(file.format.screen);
    file.info.decodable = bool(texture_for(file.info, file.format.screen ? StoredTexels{} : file.format.texels));
    return file;
}

}  // namespace

Result<TextureInfo> dds_info(ByteSource& source) {
    auto file = parse(source);
    if (!file) return file.error();
    return std::move(file->info);
}

namespace {

/// Levels of eight bits a channel.
Result<Texture> screen_texture(ByteSource& source, const Dds& file, Decode decode) {
    auto texture = texture_for(file.info, StoredTexels{screen_encoding(decode)});
    if (!texture) return texture;
    for (int l = 0; l < file.info.levels; ++l)
        texture->levels.emplace_back(texture->face_bytes(l) * std::size_t(texture->faces));
    std::uint64_t at = file.data_offset;
    for (int face = 0; face < texture->faces; ++face)
        for (int l = 0; l < file.info.levels; ++l) {
            const auto stored = source.take(at, image_bytes(file, l), "level");
            if (!stored) return stored.error();
            at += stored->size();
            decode_screen_texels(*file.format.screen, decode, stored->data(), texture->level_width(l),
                                 texture->level_height(l),
                                 texture->levels[std::size_t(l)].data() + texture->face_bytes(l) * std::size_t(face));
        }
    return texture;
}

}  // namespace

Result<Texture> dds_texture(ByteSource& source, Decode decode) {
    const auto file = parse(source);
    if (!file) return file.error();
    if (file->format.screen) return screen_texture(source, *file, decode);
    auto texture = texture_for(file->info, file->format.texels);
    if (!texture) return texture;
    const StoredTexels& texels = *file->format.texels;
    for (int l = 0; l < file->info.levels; ++l)
        texture->levels.emplace_back(
            std::size_t(stored_level_bytes(*texture, texels, l) / std::uint64_t(texels.bytes())) *
            std::size_t(encoding_bytes(texture->encoding)));
    std::uint64_t at = file->data_offset;
    for (int face = 0; face < texture->faces; ++face)
        for (int l = 0; l < file->info.levels; ++l) {
            const std::uint64_t bytes = image_bytes(*file, l);
            const auto stored = source.take(at, bytes, "level");
            if (!stored) return stored.error();
            at += bytes;
            const std::size_t count = std::size_t(bytes) / std::size_t(texels.bytes());
            widen_texels(texels, stored->data(), count,
                         texture->levels[std::size_t(l)].data() +
                             count * std::size_t(encoding_bytes(texture->encoding)) * std::size_t(face));
        }
    return texture;
}

}  // namespace domelight
