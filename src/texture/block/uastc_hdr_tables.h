#pragma once
// Tables for the kernels of uastc_hdr_fit.simd.cpp.

#include <cstdint>

namespace domelight::simd {

/// For each value 0 .. 255 the nearest that endpoints of a range of `levels` (192 or 80) can have, among those which
/// share the value's upper `shared` bits (0 .. 4).
const std::int32_t* storable_table(int levels, int shared);

/// astc_partition() of k_uastc_seeds[k].
std::uint32_t uastc_partition_bits(int k);

}  // namespace domelight::simd
