#pragma once
// One block of ASTC HDR, 4 x 4 texels, as numbers, in the forms that UASTC HDR 4x4 consists of. Khronos Data Format
// Specification 1.3, chapter 23.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace domelight {

/// Colour endpoint modes: the representation of a pair of HDR colours.
enum : int {
    k_cem_hdr_base_scale = 7,  ///< four values: a colour, and the same shifted by one number in all channels
    k_cem_hdr_rgb = 11         ///< six values: two colours
};

struct AstcBlock {
    bool solid = false;                      ///< one colour (a "void extent"); everything else is then ignored
    std::array<std::uint16_t, 3> colour{};   ///< halves
    int weight_range = 8;                    ///< index into k_ise_ranges; 4 x 4 weights, one plane
    int endpoint_mode = k_cem_hdr_rgb;       ///< the same in all subsets
    int subsets = 1;                         ///< 1 or 2
    int seed = 0;                            ///< of the partition, 0..1023, where there are two subsets
    std::array<std::uint8_t, 12> values{};   ///< endpoint values 0..255, of one subset after the other
    std::array<std::uint8_t, 16> weights{};  ///< ranks: 0 the smallest weight of the range; row by row
};

/// Values of a subset's endpoints.
constexpr int endpoint_values(int endpoint_mode) {
    return endpoint_mode == k_cem_hdr_rgb ? 6 : 4;
}

/// Index into k_ise_ranges of the finest range in which the block's endpoint values fit beside its weights; the format
/// leaves no choice.
int astc_endpoint_range(int weight_range, int endpoint_mode, int subsets);

/// Bit i is set where texel i (row by row) belongs to the second of two subsets ("Partition Pattern Generation").
std::uint32_t astc_partition(int seed);

/// The block's 16 bytes. Endpoint values must belong to the range.
void pack_astc(const AstcBlock& block, std::span<std::uint8_t, 16> out);

/// The numbers of 16 bytes. Empty if the block is valid ASTC of another kind, or not valid.
std::optional<AstcBlock> unpack_astc(std::span<const std::uint8_t, 16> in);

/// The two colours of one subset in steps of 1/128 octave, 0 .. 4095, from its endpoint values ("HDR Endpoint Modes").
struct AstcEndpoints {
    std::array<int, 3> low, high;  ///< at weight 0 and at weight 64
};
AstcEndpoints astc_endpoints(int endpoint_mode, const std::uint8_t* values);

/// Half of a colour on ASTC's 16-bit scale, which is almost logarithmic: 2048 steps an octave. Never infinite.
std::uint16_t half_from_astc(int value);

/// All texels as halves, row by row, three channels (alpha is 1).
void decode_astc(const AstcBlock& block, std::span<std::uint16_t, 48> rgb);

}  // namespace domelight
