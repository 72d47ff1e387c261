#pragma once

#include "base/aligned.h"
#include "filtering/resample/reproject_block.h"

#include <span>
#include <vector>

namespace domelight {

namespace simd {

/// Doubles that a source cell takes: eight coefficients of four channels, the fourth of which is solid angle.
constexpr std::size_t k_cell_doubles = 32;
/// Elements beyond the last that the functions below may read or write.
constexpr std::size_t k_cell_slack = 8;

/// The functions within the cells of a row (reproject_detail::Source::cell), `count` floats of interleaved channels.
struct CellRow {
    const float* rows[5];  ///< source rows y - 2 .. y + 2 at the first cell; two more texels on either side are read
    double density_slope;  ///< Source::density_slope
    double* value[5];      ///< out: mean, across, down, across2, down2 of each float
};
void fill_cell_row(const CellRow& row, std::size_t count);

/// Coefficients of cells for integrate_sides(), from left to right: the sums of the cells before it (constant, slope,
/// curve), then its own function (mean, down, down2, across, across2), all times solid angle.
///
/// value         as CellRow, of consecutive cells
/// cell          the index in `value` of each of the row's cells
/// solid_angle   of each
void sum_cell_row(const double* const value[5], std::span<const int> cell, const double* solid_angle, double* cells);

/// A rectangle of source texels.
struct SideTile {
    const double* cells;          ///< of sum_cell_row(), row by row
    const double* density_slope;  ///< of each row
    double x0, y0;                ///< its first texel
    int width, height;
    bool is_even;  ///< no row has a density slope
};

/// ∫ G dy (reproject_detail::TileIntegrator) along straight lines from (ax, ay) to (bx, by): four doubles each. Reads and
/// writes up to k_cell_slack lines beyond the last.
struct Lines {
    const double *ax, *ay, *bx, *by;
    double* sums;
};
void integrate_sides(const SideTile& tile, const Lines& lines, std::size_t count);

}  // namespace simd

namespace reproject_detail {

/// TileIntegrator's integrals along all sides of a block, by SIMD.
class SideIntegrator {
  public:
    /// Prepares the cells under the block. False if there are too many.
    bool prepare(const Source& source, const Block& block);
    /// Fills `sums`. `place(x, y)` is the source position of a point in texels of the target's chart, called where sides
    /// have several parts.
    void integrate(const Block& block, const PlaceOf& place, SideSums& sums);

  private:
    /// The range of columns that the block touches in a row.
    struct Range {
        int first = 0, end = 0;
    };
    void find_ranges(const Block& block);
    void fill_row(const Source& source, int chart, int y, Range range);
    void begin_lines(std::size_t count);
    /// Writes the parts of the side from corner (i, j) to (i + di, j + dj) from line n on, and returns the next line.
    std::size_t add_side(const Block& block, const PlaceOf& place, int i, int j, int di, int dj, std::size_t n);
    void run(std::size_t count);
    /// Sums of `parts` lines each, from line `first` on.
    void add_up(int parts, std::size_t first, std::vector<SideSum>& sums) const;

    SourceBox box_;
    std::vector<Range> ranges_;
    AlignedArray<double> cells_;
    std::vector<double> density_slope_, value_, solid_angle_;
    std::vector<int> cell_;
    bool is_even_ = true;
    std::vector<double> ax_, ay_, bx_, by_, line_sums_;
};

}  // namespace reproject_detail

}  // namespace domelight
