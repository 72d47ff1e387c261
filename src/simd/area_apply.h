#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace domelight::simd {

/// Source rows in memory: four floats a texel (RGB and one of no meaning), the first `padding` texels again behind the
/// last.
struct RowRing {
    const float* data = nullptr;
    std::ptrdiff_t stride = 0;  ///< floats from one row to the next
    int capacity = 0;           ///< rows, a power of two: row j is at j & (capacity - 1)
    int width = 0;
    int height = 0;  ///< of the whole source
};
inline constexpr int k_ring_padding = 64;

/// The weights of one output texel: rows x columns source texels, the columns counted from an instance's own origin.
struct Stencil {
    std::int32_t row = 0, column = 0;
    std::int32_t rows = 0, columns = 0;  ///< columns is even; a last one may weigh nothing
    std::uint32_t first = 0;             ///< of its weights, row by row
};

/// One of the places on the sphere where the same stencil applies.
struct StencilInstance {
    int column_origin = 0;  ///< source column of the stencil's column 0; in [0, width)
    int direction = 1;      ///< -1: the stencil's columns run to the left
    std::ptrdiff_t out = 0, out_i = 0,
                   out_j = 0;  ///< output texel (of 3 floats) of the tile's texel (0, 0), and its steps
};

/// A block of output texels, stencils row by row (i fastest).
struct StencilBlock {
    std::span<const Stencil> stencils;
    const float* weights = nullptr;
    int columns = 0, rows = 0;
    int first_column = 0, last_column = 0;  ///< the least and the greatest source column of all stencils
};

/// Writes sum weight * source of every texel of the block and every instance. `flipped`: the source upside down.
void apply_stencils(const StencilBlock& block, std::span<const StencilInstance> instances, const RowRing& ring,
                    bool flipped, float* out);

}  // namespace domelight::simd
