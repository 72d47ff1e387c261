#include "texture/block/uastc_hdr.h"

#include "texture/block/astc_ise.h"
#include "texture/block/uastc_hdr_fit.h"
#include "texture/texel/half.h"

#include <algorithm>

namespace domelight {

bool is_uastc_hdr(const AstcBlock& block) {
    if (block.solid) return true;
    if (block.weight_range < k_ise_3) return false;
    if (block.subsets == 2 && std::find(k_uastc_seeds.begin(), k_uastc_seeds.end(), block.seed) == k_uastc_seeds.end())
        return false;
    const bool rgb = block.endpoint_mode == k_cem_hdr_rgb;
    const int finest = block.subsets == 1 ? k_ise_16 : rgb ? k_ise_4 : k_ise_8;
    if (block.weight_range > finest) return false;
    for (int s = 0; s < block.subsets; ++s) {
        const AstcEndpoints e =
            astc_endpoints(block.endpoint_mode, block.values.data() + s * endpoint_values(block.endpoint_mode));
        for (std::size_t c = 0; c < 3; ++c)
            if (std::max(e.low[c], e.high[c]) > k_uastc_end_max) return false;
    }
    return true;
}

void decode_uastc_hdr(const std::uint8_t* blocks, int count, float* rgb) {
    for (int b = 0; b < count; ++b) {
        const auto block = unpack_astc(std::span<const std::uint8_t, 16>(blocks + 16 * std::size_t(b), 16));
        std::array<std::uint16_t, 48> halves{};
        if (block && is_uastc_hdr(*block)) decode_astc(*block, halves);
        for (std::size_t i = 0; i < 48; ++i) rgb[48 * std::size_t(b) + i] = float_from_half(halves[i]);
    }
}

}  // namespace domelight
