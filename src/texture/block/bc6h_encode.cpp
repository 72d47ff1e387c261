#include "texture/block/bc6h_encode.h"

#include "texture/block/bc6h.h"
#include "texture/texel/half.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

namespace domelight::bc6h {

Effort effort_of(EncodingQuality quality) {
    switch (quality) {
        case EncodingQuality::fast:
            return {.partitions = 0, .fits = 1, .refits = 1};
        case EncodingQuality::standard:
            return {.partitions = 4, .fits = 2, .refits = 1, .polish = 2};
        case EncodingQuality::high:
            return {.partitions = 8, .fits = 2, .refits = 2, .polish = 8, .nudges = 3, .step = 2, .reach = 1.15f};
        case EncodingQuality::exhaustive:
            break;
    }
    return {.partitions = k_partitions,
            .fits = 3,
            .refits = 3,
            .polish = 0,
            .nudges = 64,
            .step = 4,
            .reach = 1e30f,
            .neighbours = true};
}

void pack_solution(int mode_number, int partition, const int* ends, const int* index, std::uint8_t* block) {
    const Mode& mode = k_mode[std::size_t(mode_number)];
    Fields fields;
    fields.mode = mode_number;
    fields.partition = partition;
    for (int e = 0; e < 2 * mode.subsets; ++e)
        for (int c = 0; c < 3; ++c) {
            const int value = ends[3 * e + c];
            assert(!mode.transformed || e == 0 || std::abs(2 * (value - ends[c]) + 1) < 1 << mode.delta_bits[c]);
            fields.endpoint[std::size_t(e)][std::size_t(c)] =
                e > 0 && mode.transformed ? (value - ends[c]) & ((1 << mode.delta_bits[c]) - 1) : value;
        }
    for (std::size_t t = 0; t < k_texels; ++t) fields.index[t] = std::uint8_t(index[t]);
    // Bits that are not stored must be zero, and differences must not have wrapped around.
    assert(index[0] < 1 << (mode.index_bits() - 1));
    assert(mode.subsets == 1 || index[k_anchor[std::size_t(partition)]] < 1 << (mode.index_bits() - 1));
    pack(fields, block);
}

namespace {
namespace plain {

/// One lane.
using F = float;
using M = bool;
constexpr int k_max_lanes = 1;
int lane_count() {
    return 1;
}
F splat(float v) {
    return v;
}
F load(const float* p) {
    return *p;
}
void store(F v, float* p) {
    *p = v;
}
F select(M m, F a, F b) {
    return m ? a : b;
}
F smaller(F a, F b) {
    return b < a ? b : a;
}
F larger(F a, F b) {
    return a < b ? b : a;
}
F floor_of(F v) {
    return std::floor(v);
}
bool any(M m) {
    return m;
}
F half_bits_of(F v) {
    return float(half_from_float(v));
}

#include "texture/block/bc6h_search-inl.h"

}  // namespace plain
}  // namespace

void encode_plain(const float* texels, int count, EncodingQuality quality, std::uint8_t* blocks) {
    const Effort effort = effort_of(quality);
    for (int i = 0; i < count; ++i) plain::encode_lanes(texels + 48 * i, 1, effort, blocks + k_block_bytes * i);
}

}  // namespace domelight::bc6h
