#pragma once
// Constants of the DDS container (Direct3D documentation, "DDS_HEADER" and "DDS_HEADER_DXT10") for its reader and
// writer.

#include <cstdint>

namespace domelight {

inline constexpr std::uint64_t k_dds_header_bytes = 4 + 124, k_dds_dx10_bytes = 20;
inline constexpr std::uint32_t k_dds_dx10 = 0x30315844;  // "DX10"

enum : std::uint32_t {
    k_ddsd_caps = 0x1,
    k_ddsd_height = 0x2,
    k_ddsd_width = 0x4,
    k_ddsd_pitch = 0x8,
    k_ddsd_pixel_format = 0x1000,
    k_ddsd_mip_map_count = 0x20000,
    k_ddsd_linear_size = 0x80000,
    k_ddsd_depth = 0x800000,
    k_ddpf_alpha_pixels = 0x1,
    k_ddpf_four_cc = 0x4,
    k_ddpf_rgb = 0x40,
    k_ddscaps_complex = 0x8,
    k_ddscaps_texture = 0x1000,
    k_ddscaps_mip_map = 0x400000,
    k_ddscaps2_cube_map = 0x200,
    k_ddscaps2_all_faces = 0xfc00,
    k_ddscaps2_volume = 0x200000,
    k_dx10_dimension_1d = 2,
    k_dx10_dimension_2d = 3,
    k_dx10_dimension_3d = 4,
    k_dx10_misc_cube = 0x4,
};

}  // namespace domelight
