#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace domelight::simd {

/// Source rows in memory: four floats a texel (RGB and an unused one). A row is stored in quarters of ceil(width / 4)
/// columns (the last one is shorter), each followed by the next `k_ring_padding` columns, wrapping around. So short
/// runs of columns are contiguous, and the same position in each quarter does not map to the same lines of a cache.
struct RowRing {
    const float* data = nullptr;
    std::ptrdiff_t stride = 0;  ///< floats from one row to the next
    int capacity = 0;           ///< rows, a power of two: row j is at j & (capacity - 1)
    int width = 0;
    int height = 0;  ///< of the whole source

    int quarter() const { return (width + 3) / 4; }
    std::ptrdiff_t quarter_stride() const;
    /// Offset of column 0 .. width - 1 in a row.
    std::ptrdiff_t place(int column) const {
        std::ptrdiff_t offset = 0;
        for (; column >= quarter(); column -= quarter()) offset += quarter_stride();
        return offset + 4 * std::ptrdiff_t(column);
    }
};
inline constexpr int k_ring_padding = 64;

inline std::ptrdiff_t RowRing::quarter_stride() const {
    // Some lines more than a multiple of 4 KB (1024 floats).
    return (4 * std::ptrdiff_t(quarter() + k_ring_padding) + 1023) / 1024 * 1024 + 16 * 11;
}

/// The weights of one output texel: rows x columns source texels. Columns are counted from the origin of an instance.
struct Stencil {
    std::int32_t row = 0, column = 0;
    std::int32_t rows = 0, columns = 0;  ///< columns is even; the last one may have weight 0
    std::uint32_t first = 0;             ///< of its weights, row by row
};

/// One of the positions on the sphere where the same stencil applies.
struct StencilInstance {
    int column_origin = 0;  ///< source column of the stencil's column 0; in [0, width)
    int direction = 1;      ///< -1: the stencil's columns run to the left
    std::ptrdiff_t out = 0, out_i = 0,
                   out_j = 0;  ///< output texel (of 3 floats) of the tile's texel (0, 0), and its steps
};

/// Largest side of a block.
inline constexpr int k_block_side = 16;

/// A block of output texels, stencils row by row (i fastest).
struct StencilBlock {
    std::span<const Stencil> stencils;
    const float* weights = nullptr;
    int columns = 0, rows = 0;
    int first_row = 0, last_row = 0, first_column = 0, last_column = 0;  ///< the part of the source that they need
};

/// Writes sum weight * source of every texel of the block and every instance. `flipped`: the source upside down.
void apply_stencils(const StencilBlock& block, std::span<const StencilInstance> instances, const RowRing& ring,
                    bool flipped, float* out);

}  // namespace domelight::simd
