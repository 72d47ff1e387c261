#pragma once

#include <cstddef>

namespace domelight::simd {

/// A direction or a row of texels by its colatitude θ.
struct Colatitude {
    double sin_half, cos_half;  ///< of θ / 2: differences of two rows keep their digits
    float sin;                  ///< of θ
    float weight = 0;           ///< of a row: solid angle of a cell over the width of a texel in azimuth
};

/// The axis of a GGX lobe, K ~ max(c, 0) / (s^2 + b^2)^2 with s the chord and c the cosine.
struct LobeAxis {
    Colatitude at;
    double x;       ///< azimuth in columns of the image
    float b2;       ///< b^2, b = 2 α / √(1 − α²)
    float columns;  ///< of the image, all around
};

/// The weighted sum of texels, and of the weights alone.
struct LobeSum {
    double r = 0, g = 0, b = 0, weight = 0;
};

/// Rows of cells in planes: red, green and blue times the cell's width, then the width. The width is 1, but less for a
/// last cell that the image cuts off.
struct CellRows {
    const float* planes;    ///< of row `first_row`, column 0
    std::ptrdiff_t stride;  ///< floats from plane to plane; a row has four
    int first_row;
    const float* x;            ///< the middle of each cell, in columns of the image
    const Colatitude* places;  ///< of all rows, from row 0
    float curvature;           ///< times the kernel's Laplacian: what a cell's size does to its weight (square radians)
};

/// Cells of the rows [row_begin, row_end) and up to two ranges of columns, without those in the hole.
struct CellBox {
    int row_begin, row_end;
    int begin[2], end[2];
    int hole_row_begin, hole_row_end;
    float hole_begin, hole_end;  ///< in columns of the image, from the lobe's axis
};

LobeSum sum_cells(const CellRows& rows, const CellBox& box, const LobeAxis& axis);

/// Pairs of texel rows with the bilinear patches between them, each integrated by 3 x 3 Gauss-Legendre nodes.
struct PatchRow {
    const float *upper, *lower;  ///< plane 0 of each row, at the texel left of the first patch
    bool use_upper, use_lower;   ///< whether the row's texels count; else they are 0
    const Colatitude* nodes;     ///< three
};

/// The texels `first` .. `first + count - 1` of a row counting, those beyond them 0: `count` + 1 patches. `all_around`:
/// `count` is a whole row, and so is the number of patches.
struct PatchColumns {
    int first, count;
    bool all_around;
    std::ptrdiff_t stride;  ///< floats from plane to plane
};

LobeSum sum_patches(const PatchRow& row, const PatchColumns& columns, const LobeAxis& axis);

}  // namespace domelight::simd
