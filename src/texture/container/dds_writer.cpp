// Writes DDS, with a DX10 header or as it was before.
#include "domelight/texture/texture.h"

#include "io/file/byte_buffer.h"
#include "texture/container/dds.h"
#include "texture/container/dds_formats.h"
#include "texture/container/scaled_bytes.h"
#include "texture/container/texture_layout.h"

#include <utility>

namespace domelight {

namespace {

/// What follows the sizes: a pixel format of 32 bytes.
void add_pixel_format(ByteBuffer& head, std::uint32_t four_cc) {
    head.u32(32);
    if (four_cc) {
        head.u32(k_ddpf_four_cc);
        head.u32(four_cc);
        for (int i = 0; i < 5; ++i) head.u32(0);
        return;
    }
    // Four bytes a texel: red, green, blue, alpha from the lowest on.
    head.u32(k_ddpf_rgb | k_ddpf_alpha_pixels);
    head.u32(0);
    head.u32(32);
    for (int i = 0; i < 4; ++i) head.u32(0xffu << 8 * i);
}

/// `four_cc`: DX10, a D3DFORMAT number, or 0 for RGBA bytes.
ByteBuffer header(const Texture& texture, std::size_t levels, std::uint32_t four_cc) {
    const bool cube = texture.faces == 6, mips = levels > 1, blocks = encoding_block(texture.encoding) > 1;
    ByteBuffer head;
    head.text("DDS ");
    head.u32(124);
    head.u32(k_ddsd_caps | k_ddsd_height | k_ddsd_width | (blocks ? k_ddsd_linear_size : k_ddsd_pitch) |
             k_ddsd_pixel_format | (mips ? k_ddsd_mip_map_count : 0u));
    head.u32(std::uint32_t(texture.height));
    head.u32(std::uint32_t(texture.width));
    // Bytes of a row of texels, or of the whole finest level of a face where there are blocks.
    head.u32(std::uint32_t(blocks ? texture.face_bytes(0) : texture.face_bytes(0) / std::size_t(texture.height)));
    head.u32(0);  // depth
    head.u32(std::uint32_t(levels));
    for (int i = 0; i < 11; ++i) head.u32(0);
    add_pixel_format(head, four_cc);
    head.u32(k_ddscaps_texture | (mips ? k_ddscaps_mip_map : 0u) | (mips || cube ? k_ddscaps_complex : 0u));
    head.u32(cube ? k_ddscaps2_cube_map | k_ddscaps2_all_faces : 0u);
    for (int i = 0; i < 3; ++i) head.u32(0);
    return head;
}

TextureLayout layout_behind(ByteBuffer head, int faces, std::span<const std::uint64_t> level_bytes) {
    TextureLayout layout;
    layout.frame.push_back({0, head.take()});
    layout.size = layout.frame.back().bytes.size();
    // Unlike in KTX all levels of a face come before the next face.
    for (int face = 0; face < faces; ++face)
        for (std::size_t l = 0; l < level_bytes.size(); ++l) {
            layout.blocks.push_back({layout.size, int(l), face, 1});
            layout.size += level_bytes[l] / std::uint64_t(faces);
        }
    return layout;
}

}  // namespace

Result<TextureLayout> dds_layout(const Texture& texture, std::span<const std::uint64_t> level_bytes) {
    if (dxgi_number(texture.encoding) == 0)
        return Error{name_of(texture.encoding) + " cannot be stored as dds", "",
                     "Direct3D has no such format; use ktx2."};
    ByteBuffer head = header(texture, level_bytes.size(), k_dds_dx10);
    head.u32(dxgi_number(texture.encoding));
    head.u32(k_dx10_dimension_2d);
    head.u32(texture.faces == 6 ? k_dx10_misc_cube : 0u);
    head.u32(1);  // array size, in cubes
    head.u32(0);  // alpha mode unknown: it is 1 everywhere
    return layout_behind(std::move(head), texture.faces, level_bytes);
}

Result<TextureLayout> dds9_layout(const Texture& texture, std::span<const std::uint64_t> level_bytes) {
    const std::uint32_t number = d3d_number(texture.encoding);
    if (!number && !is_scaled_bytes(texture.encoding))
        return Error{name_of(texture.encoding) + " has no place in DDS headers from before DX10", "", ""};
    return layout_behind(header(texture, level_bytes.size(), number), texture.faces, level_bytes);
}

Result<void> write_dds(const std::filesystem::path& file, const Texture& texture) {
    const auto layout = dds_layout(texture, level_bytes_of(texture));
    if (!layout) return layout.error().at(file.string());
    return write_with_layout(file, *layout, texture.faces, texture.levels);
}

Result<void> write_dds9(const std::filesystem::path& file, const Texture& texture) {
    const auto layout = dds9_layout(texture, level_bytes_of(texture));
    if (!layout) return layout.error().at(file.string());
    return write_with_layout(file, *layout, texture.faces, texture.levels);
}

Result<TexelBytes> dds_bytes(const Texture& texture) {
    const auto layout = dds_layout(texture, level_bytes_of(texture));
    if (!layout) return layout.error();
    return bytes_with_layout(*layout, texture.faces, texture.levels);
}

Result<TexelBytes> dds9_bytes(const Texture& texture) {
    const auto layout = dds9_layout(texture, level_bytes_of(texture));
    if (!layout) return layout.error();
    return bytes_with_layout(*layout, texture.faces, texture.levels);
}

}  // namespace domelight
