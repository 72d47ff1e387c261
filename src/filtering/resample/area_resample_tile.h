#pragma once

#include "base/aligned.h"
#include "base/mutex.h"
#include "filtering/resample/area_apply.h"
#include "filtering/resample/area_pieces.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>
namespace domelight::area {

/// A lat-long source's rows, for stencils: cell row j = -1 .. H - 1 lies between the centres of rows j and j + 1 (the
/// polar ones are half as high); entry j + 1 of each array.
struct SourceGrid {
    SourceGrid(int width, int height);

    int width, height;
    double column_angle, row_angle;
    std::vector<double> row_cos, row_sin;          ///< of theta at the cell's top
    std::vector<double> row_tan2;                  ///< tan^2 there; infinite from the equator on
    std::vector<double> whole_upper, whole_lower;  ///< ∫ (1 - v) sin theta and ∫ v sin theta over the cell
};

/// The source's columns as seen along a great circle: node n lies at psi = (n - phase) * column_angle, psi = 0 where
/// the circle is nearest the pole, and is node origin + direction * n of the stencils.
struct LineFrame {
    LineFrame() = default;
    LineFrame(const SourceGrid& grid, double phase, int origin, int direction);

    double phase = 0;
    int origin = 0, direction = 1;
    std::vector<double> tan, cos;  ///< of node n's psi; tan infinite from 90 degrees on
};

/// Where the columns of texel centres lie against a face: node n at azimuth (n - phase) * column_angle from the face's
/// middle (side faces) or from the +x axis (polar faces).
struct ColumnPhase {
    ColumnPhase(const SourceGrid& grid, double phase);

    double phase;
    LineFrame forward, backward;     ///< along growing and falling azimuth from 0
    LineFrame from_z, from_minus_z;  ///< from +90 degrees backward, from -90 degrees forward
};

/// A block of output texels [i0, i1) x [j0, j1) of a face in the source's aligned frame. On a side face i runs along
/// growing azimuth and j downwards, at most over the upper half (with the middle row of an odd size). On a polar face i
/// runs along x and j along z, both from the middle of the face.
struct TileShape {
    bool polar = false;
    int i0 = 0, i1 = 0, j0 = 0, j1 = 0;
};

/// Memory for stencils, allocated in large blocks and freed all at once. Safe to use from many threads.
class StencilArena {
  public:
    /// 64-byte aligned.
    std::byte* allocate(std::size_t bytes);

  private:
    static constexpr std::size_t k_block = std::size_t(4) << 20;
    Mutex mutex_;
    std::vector<AlignedArray<std::byte>> blocks_;
    std::size_t used_ = 0;
};

/// A tile's stencils, each summing to 1, in an arena.
struct Tile {
    std::span<simd::Stencil> stencils;
    const float* weights = nullptr;
    int first_row = 0, last_row = 0, first_column = 0, last_column = 0;  ///< the part of the source that they touch
};

/// Computes the weights of output texels: the exact overlap of each with every source texel's tent.
///
/// As in the plain version by Stokes, the integral over a texel = ∮ F dphi, with every border line a great
/// circle cot theta = kappa cos psi: a horizontal texel edge at height t of a side face has kappa = t and psi from the
/// face's middle (the vertical ones are meridians, dphi = 0); the line x = c of a polar face has kappa = 1/c and psi
/// from the x axis, z = c likewise from the z axis. The circles are cut at the source's columns and rows and at the
/// texel grid; each piece adds what lies above it inside its cell to its texel and to the neighbour beyond with the
/// opposite sign, and its width dpsi to all cells above. So energy telescopes exactly.
class TileBuilder {
  public:
    TileBuilder(const SourceGrid& grid, int size, StencilArena& arena) : grid_(grid), size_(size), arena_(arena) {}

    Tile build(const TileShape& shape, const ColumnPhase& columns);
    /// The quarter -45..45 degrees (about the +x axis) of the middle texel of a polar face of odd size, as the stencil
    /// of a whole texel: the texel is the mean of the four quarters.
    Tile build_pole_quarter(const ColumnPhase& columns);

  private:
    static constexpr int k_nobody = std::numeric_limits<int>::min();
    /// A border line of the tile: texels `plus` + k and `minus` + k (times stride) lie above and below it, k counted
    /// along the line.
    struct Line {
        double kappa, scale;  ///< the texel grid's lines are at T = |2 k - size| * scale
        int plus, minus, stride, along0;
    };
    struct Run {
        int first, last, plus, minus;
    };
    struct Box {
        int column0 = std::numeric_limits<int>::max(), column1 = std::numeric_limits<int>::min();
        int row0 = std::numeric_limits<int>::max(), row1 = std::numeric_limits<int>::min();
        std::size_t nodes = 0, widths = 0;
        int columns() const { return column1 - column0 + 1; }
        int rows() const { return row1 - row0 + 1; }
        int node_columns() const { return (columns() + 2) / 2 * 2; }  ///< one more than cells, made even
        bool empty() const { return column1 < column0; }
    };

    void clear(int texels);
    void grow();
    void add_side_lines(const TileShape& shape, const ColumnPhase& columns);
    void add_polar_lines(const TileShape& shape, const ColumnPhase& columns);
    void add_line(const Line& line, const LineFrame& outward, const LineFrame* inward, int begin, int end);
    void add_part(const Line& line, const LineFrame& frame, int first, int end, int step);
    void include(int texel, int column_a, int column_b, int row_a, int row_b);
    void scatter();
    void add_run(const Run& run, int texel, double sign);
    Tile finish(int first_mirrored, double total);
    simd::Stencil shape_of(const Box& box, bool mirrored) const;
    void sum_cells(const Box& box);
    void store_weights(const Box& box, const simd::Stencil& stencil, bool mirrored, double total, float* to);

    const SourceGrid& grid_;
    int size_;
    StencilArena& arena_;
    std::size_t count_ = 0;
    std::vector<double> from_, to_, column_tan_, column_cos_, row_cos_, row_sin_;
    std::vector<double> upper_, lower_, width_;  ///< two each: left and right
    std::vector<std::int32_t> column_, row_;
    std::vector<Run> runs_;
    std::vector<Box> boxes_;
    std::vector<double> nodes_, widths_, folded_;
};

}  // namespace domelight::area
