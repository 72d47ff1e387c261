#pragma once
// Constants of the KTX 1.1 container for its reader and writer.

#include <array>
#include <cstdint>

namespace domelight {

inline constexpr std::array<std::uint8_t, 12> k_ktx1_identifier{0xab, 'K',  'T',  'X',  ' ',  '1',
                                                                '1',  0xbb, '\r', '\n', 0x1a, '\n'};
inline constexpr std::uint64_t k_ktx1_header_bytes = 64;
inline constexpr std::uint32_t k_ktx1_endianness = 0x04030201;

/// OpenGL's internal formats that we write and decode.
enum : std::uint32_t {
    k_gl_rgba32f = 0x8814,
    k_gl_rgb32f = 0x8815,
    k_gl_rgba16f = 0x881a,
    k_gl_rgb16f = 0x881b,
    k_gl_r16f = 0x822d,
    k_gl_r32f = 0x822e,
    k_gl_rg16f = 0x822f,
    k_gl_rg32f = 0x8230,
    k_gl_r11f_g11f_b10f = 0x8c3a,
    k_gl_rgb9_e5 = 0x8c3d,
    k_gl_bptc_unsigned_float = 0x8e8f,
    k_gl_rgba8 = 0x8058,
    k_gl_unsigned_byte = 0x1401,
    k_gl_astc4x4 = 0x93b0,  // of any dynamic range
    k_gl_astc6x6 = 0x93b4,
};

}  // namespace domelight
