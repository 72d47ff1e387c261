#pragma once
// UASTC HDR blocks for tests: every mode, with random contents.

#include "texture/block/astc_block.h"
#include "texture/block/astc_ise.h"
#include "texture/block/uastc_hdr.h"

#include <string>

namespace domelight::test {

/// A small generator, so that failures repeat.
struct Noise {
    std::uint32_t state = 1;
    std::uint32_t next() {
        state = state * 1664525u + 1013904223u;
        return state >> 8;
    }
    int below(int n) { return int(std::uint64_t(next()) * std::uint64_t(n) >> 24); }
    float unit() { return float(next()) * 0x1p-24f; }
};

/// The mode of a UASTC HDR block: "mode 11, 2 subsets, 4 weights".
inline std::string mode_name(const AstcBlock& block) {
    if (block.solid) return "solid";
    return "mode " + std::to_string(block.endpoint_mode) + ", " + std::to_string(block.subsets) + " subsets, " +
           std::to_string(k_ise_ranges[std::size_t(block.weight_range)].levels) + " weights";
}

/// A valid block of mode `i` (modulo 24) with random contents.
inline AstcBlock random_uastc_block(Noise& noise, int i) {
    AstcBlock block;
    const int mode = i % 24;
    if (mode == 23) {
        block.solid = true;
        for (auto& c : block.colour) c = std::uint16_t(noise.below(0x7c00));
        return block;
    }
    // One subset: 3 to 16 weights. Two: 3 to 8 of base and scale, 3 or 4 of two colours.
    const bool rgb = mode < 8 || mode >= 21;
    block.endpoint_mode = rgb ? k_cem_hdr_rgb : k_cem_hdr_base_scale;
    block.subsets = mode < 16 ? 1 : 2;
    block.weight_range = 1 + (mode < 16 ? mode % 8 : mode < 21 ? mode - 16 : mode - 21);
    if (block.subsets == 2) block.seed = k_uastc_seeds[std::size_t(noise.below(k_uastc_partitions))];
    const int levels = k_ise_ranges[std::size_t(block.weight_range)].levels;
    const int range = astc_endpoint_range(block.weight_range, block.endpoint_mode, block.subsets);
    for (auto& w : block.weights) w = std::uint8_t(noise.below(levels));
    do {
        for (int v = 0; v < block.subsets * endpoint_values(block.endpoint_mode); ++v)
            block.values[std::size_t(v)] =
                std::uint8_t(ise_colour(range, noise.below(k_ise_ranges[std::size_t(range)].levels)));
    } while (!is_uastc_hdr(block));
    return block;
}

}  // namespace domelight::test
