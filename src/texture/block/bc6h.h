#pragma once
// BC6H, unsigned (DXGI's BC6H_UF16, Vulkan's BC6H_UFLOAT_BLOCK, OpenGL's RGB_BPTC_UNSIGNED_FLOAT): 4 x 4 texels of RGB
// half floats in 16 bytes. A block has one or two pairs of colours (subsets); its texels lie on the lines between them,
// in steps of the half floats' bit patterns, so that steps are ratios rather than differences. Fourteen modes
// distribute the bits differently. Direct3D 11.3 functional specification, section 19.5.13; Khronos Data Format
// Specification 1.3, chapter 20.
//
// Texels of a block are counted row by row.

#include <array>
#include <cstdint>

namespace domelight::bc6h {

inline constexpr int k_texels = 16, k_block_bytes = 16, k_modes = 14, k_partitions = 32;

/// Texels as half floats' bits, RGB.
using HalfTexels = std::array<std::array<std::uint16_t, 3>, k_texels>;

/// The specification's numbers for modes 1 to 14, here 0 to 13.
struct Mode {
    int code, code_bits;  ///< the mode as it stands in the block's first bits
    int subsets;
    bool transformed;   ///< all endpoints but the first are stored as differences from it
    int endpoint_bits;  ///< of the first endpoint; precision of all
    int delta_bits[3];  ///< of the others, by channel
    int index_bits() const { return subsets == 2 ? 3 : 4; }
};
extern const std::array<Mode, k_modes> k_mode;

/// Bit t: texel t belongs to the second subset.
extern const std::array<std::uint16_t, k_partitions> k_partition;
/// The second subset's texel whose index lacks its top bit, which is zero; the first subset's is texel 0.
extern const std::array<std::uint8_t, k_partitions> k_anchor;

/// Share of the second endpoint by index, in 64ths.
inline constexpr int k_weights_3[8] = {0, 9, 18, 27, 37, 46, 55, 64};
inline constexpr int k_weights_4[16] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};

/// The fields of a block as stored, before anything is computed from them.
struct Fields {
    int mode = 0;
    int partition = 0;
    /// As stored: of `endpoint_bits` or `delta_bits`, not sign-extended. Order: first subset's two ends, the second's.
    std::array<std::array<int, 3>, 4> endpoint{};
    std::array<std::uint8_t, k_texels> index{};
};

/// Whole numbers of `bits` bits to the 16-bit scale on which colours are interpolated.
inline int unquantise(int value, int bits) {
    if (bits >= 15 || value == 0) return value;
    if (value == (1 << bits) - 1) return 0xffff;
    return ((value << 16) + 0x8000) >> bits;
}

/// The half float's bits of an interpolated value: 65535 becomes 0x7bff, the largest finite number.
inline int half_bits(int value) {
    return (value * 31) >> 6;
}

void pack(const Fields& fields, std::uint8_t* block);
/// False for the four reserved modes.
bool unpack(const std::uint8_t* block, Fields& fields);

/// Both ends of each subset on the 16-bit scale.
std::array<std::array<int, 3>, 4> endpoints(const Fields& fields);

/// Bit-exact. Reserved modes give zeros.
void decode(const std::uint8_t* block, HalfTexels& texels);

/// The same as floats, 16 times RGB.
void decode(const std::uint8_t* block, float* rgb);

}  // namespace domelight::bc6h
