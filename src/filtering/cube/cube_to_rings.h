#pragma once

#include "filtering/cube/cube_nodes.h"
#include "filtering/cube/sparse_pixels.h"
#include "filtering/harmonic/sphere_grid.h"
#include "projection/bordered_cube.h"

#include <span>
#include <vector>

namespace domelight {

/// The linear map from a cube's texels to the points of a grid of rings, for cubes of one size that are expanded many times:
/// it is that of analyse_cube(), which spreads each patch's light over 8 x 8 points around it, with the weights computed
/// once. They are few, because of the cube's symmetry:
///
/// - The four faces at the sides are quarter turns of one another about the grid's axis, and so are the grid's points. The
///   same weights serve all four, as twelve channels. A column of such a face has one azimuth. So the map is a product: a
///   column's texels go to the rings of the column's azimuth, and these go to the grid's columns.
/// - The faces at the poles are mirror images of one another, and each is four quarter turns of itself: 24 channels go to the
///   points of a quarter of the northern rings.
class CubeToRings {
  public:
    /// grid    its width is a multiple of 4
    /// table   the weights of an interpolation from the grid's points
    /// nodes   of the quadrature, along each side of a texel; even, because a node at the pole itself would have no azimuth
    CubeToRings(int size, RingGrid grid, const simd::TapTable& table, int nodes);

    /// The points of `out`, without its surroundings.
    void apply(const BorderedCube& cube, SphereGrid& out, int threads) const;

  private:
    void prepare_sides(const simd::TapTable& table, std::span<const AxisNode> axis);
    void prepare_poles(const simd::TapTable& table, std::span<const AxisNode> axis);
    void add_sides(const BorderedCube& cube, SphereGrid& out, int threads) const;
    void add_poles(const BorderedCube& cube, SphereGrid& out, int threads) const;

    int size_;
    RingGrid grid_;
    /// A column of nodes: between which texels it lies, and the map from a column of bordered texels to the rings of
    /// first_ring_ and below.
    struct Column {
        int cell;  ///< the texel before it; -1: in the border
        float fraction;
        SparsePixels to_rings;
    };
    std::vector<Column> columns_;
    int first_ring_ = 0, ring_count_ = 0;
    int first_column_ = 0;  ///< of the grid, from the azimuth of the face's centre; negative
    SparsePixels to_columns_{0};
    SparsePixels to_cap_{0};  ///< from a bordered face to the first rings' points of a quarter, ring by ring
    int cap_rings_ = 0;
};

}  // namespace domelight
