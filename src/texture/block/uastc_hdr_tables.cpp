#include "texture/block/uastc_hdr_tables.h"

#include "texture/block/astc_ise.h"
#include "texture/block/uastc_hdr.h"

#include <array>
#include <cstdlib>

namespace domelight::simd {

namespace {

constexpr int k_ise_80 = 15, k_ise_192 = 19;

struct Tables {
    std::int32_t nearest[2][5][256];
    std::array<std::uint32_t, k_uastc_partitions> partitions;
    Tables() {
        for (int t = 0; t < 2; ++t) {
            const int range = t == 0 ? k_ise_192 : k_ise_80, levels = k_ise_ranges[std::size_t(range)].levels;
            for (int shared = 0; shared < 5; ++shared)
                for (int v = 0; v < 256; ++v) {
                    int best = -1;
                    for (int i = 0; i < levels; ++i) {
                        const int value = ise_colour(range, i);
                        if ((value ^ v) >> (8 - shared)) continue;
                        const int off = std::abs(value - v), best_off = std::abs(best - v);
                        if (best < 0 || off < best_off || (off == best_off && value < best)) best = value;
                    }
                    nearest[t][shared][v] = best;
                }
        }
        for (int k = 0; k < k_uastc_partitions; ++k)
            partitions[std::size_t(k)] = astc_partition(k_uastc_seeds[std::size_t(k)]);
    }
};

const Tables& tables() {
    static const Tables made;
    return made;
}

}  // namespace

const std::int32_t* storable_table(int levels, int shared) {
    return tables().nearest[levels == 192 ? 0 : 1][shared];
}

std::uint32_t uastc_partition_bits(int k) {
    return tables().partitions[std::size_t(k)];
}

}  // namespace domelight::simd
