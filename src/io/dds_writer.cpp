// Writes DDS with a DX10 header.
#include "domelight/texture.h"

#include "io/byte_buffer.h"
#include "io/dds.h"
#include "io/dds_formats.h"
#include "io/texture_layout.h"

namespace domelight {

Result<TextureLayout> dds_layout(const Texture& texture, std::span<const std::uint64_t> level_bytes) {
    if (dxgi_number(texture.encoding) == 0)
        return Error{encoding_name(texture.encoding) + " cannot be stored as dds", "",
                     "Direct3D has no such format; use ktx2."};
    const bool cube = texture.faces == 6, mips = level_bytes.size() > 1;
    ByteBuffer head;
    head.text("DDS ");
    head.u32(124);
    const bool blocks = encoding_block(texture.encoding) > 1;
    head.u32(k_ddsd_caps | k_ddsd_height | k_ddsd_width | (blocks ? k_ddsd_linear_size : k_ddsd_pitch) |
             k_ddsd_pixel_format | (mips ? k_ddsd_mip_map_count : 0u));
    head.u32(std::uint32_t(texture.height));
    head.u32(std::uint32_t(texture.width));
    // Bytes of a row of texels, or of the whole finest level of a face where there are blocks.
    head.u32(std::uint32_t(blocks ? texture.face_bytes(0) : texture.face_bytes(0) / std::size_t(texture.height)));
    head.u32(0);  // depth
    head.u32(std::uint32_t(level_bytes.size()));
    for (int i = 0; i < 11; ++i) head.u32(0);
    head.u32(32);  // pixel format: what it is stands in the DX10 header
    head.u32(k_ddpf_four_cc);
    head.u32(k_dds_dx10);
    for (int i = 0; i < 5; ++i) head.u32(0);
    head.u32(k_ddscaps_texture | (mips ? k_ddscaps_mip_map : 0u) | (mips || cube ? k_ddscaps_complex : 0u));
    head.u32(cube ? k_ddscaps2_cube_map | k_ddscaps2_all_faces : 0u);
    for (int i = 0; i < 3; ++i) head.u32(0);
    head.u32(dxgi_number(texture.encoding));
    head.u32(k_dx10_dimension_2d);
    head.u32(cube ? k_dx10_misc_cube : 0u);
    head.u32(1);  // array size, in cubes
    head.u32(0);  // alpha mode unknown: it is 1 everywhere

    TextureLayout layout;
    layout.frame.push_back({0, head.take()});
    layout.size = layout.frame.back().bytes.size();
    // Unlike in KTX all levels of a face come before the next face.
    for (int face = 0; face < texture.faces; ++face)
        for (std::size_t l = 0; l < level_bytes.size(); ++l) {
            layout.blocks.push_back({layout.size, int(l), face, 1});
            layout.size += level_bytes[l] / std::uint64_t(texture.faces);
        }
    return layout;
}

Result<void> write_dds(const std::filesystem::path& file, const Texture& texture) {
    const auto layout = dds_layout(texture, level_bytes_of(texture));
    if (!layout) return layout.error().at(file.string());
    return write_with_layout(file, *layout, texture.faces, texture.levels);
}

}  // namespace domelight
