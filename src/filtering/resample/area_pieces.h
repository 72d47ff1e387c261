#pragma once

#include <cstddef>

namespace domelight::simd {

/// Pieces of a great circle cot theta = kappa cos psi, each inside one cell of the source grid, psi measured by T = tan
/// psi. Structure of arrays.
struct ArcPieces {
    // In: from T = from to T = to; the tangent and cosine of psi at the cell's first column of texel centres, cosine
    // and sine of theta at its first row.
    const double *from, *to, *column_tan, *column_cos, *row_cos, *row_sin;
    // Out, two each, for the cell's left and right column of the source: ∫ w (1 - u) dpsi and ∫ w u dpsi, u the
    // position between the columns, with w = ∫ (1 - v) sin theta (upper), ∫ v sin theta (lower) over theta from the
    // cell's first row down to the circle, v the position between the rows, and w = 1 (width).
    double *upper, *lower, *width;
};

/// Fills the outputs of pieces [0, count); may read and write up to 7 entries beyond. `nodes`: Gauss-Legendre nodes a
/// piece, 2 or 3. `reversed`: the source's columns run against psi. Cells must be narrower than 0.1 radians either way.
void integrate_arc_pieces(const ArcPieces& pieces, std::size_t count, double kappa, double columns_per_radian,
                          double rows_per_radian, int nodes, bool reversed);

}  // namespace domelight::simd
