#pragma once

#include "filtering/resample/reproject_block.h"

namespace domelight::reproject_detail {

/// Light and solid angle of a region of the source. Their quotient is its mean.
struct Flux {
    Vec3d light;
    double solid_angle = 0;
    void add(double weight, const Flux& f) {
        light += f.light * weight;
        solid_angle += weight * f.solid_angle;
    }
};

/// Integrals over polygons in a rectangle of source texels [x0, x1) x [y0, y1) of one chart.
///
/// By Green's theorem ∫∫ p dx dy = ∮ G dy, G(x, y) = ∫_x0^x p dx': with G known at each texel's
/// left edge (sums along the rows), a polygon costs as much as its outline crosses texels. p is the light's density per
/// area of the picture, quadratic within a texel: G is cubic along a line, and two Gauss nodes a piece are exact.
class TileIntegrator {
  public:
    /// False if the rectangle is too large.
    bool prepare(const Source& source, int chart, const SourceBox& box);
    /// Fills `sums` with the integrals along all sides of a block. `place` as in PlaceOf, called where sides have several
    /// parts.
    void integrate(const Block& block, const PlaceOf& place, SideSums& sums) const;
    /// ∫ G dy along the straight line from (ax, ay) to (bx, by), both within the rectangle.
    Flux along(double ax, double ay, double bx, double by) const;

  private:
    struct Column {
        Flux constant;  ///< G at the texel's left edge: constant + slope eta + curve (eta^2 - 1/12)
        Vec3d slope, curve;
        Cell cell;
        double solid_angle;
    };
    Flux potential(const Column& c, double xi, double eta) const;

    int x0_ = 0, y0_ = 0, width_ = 0, height_ = 0;
    std::vector<Column> columns_;
    std::vector<double> density_slope_;  ///< of each row: Source::density_slope
    bool is_even_ = true;                ///< all of them 0
};

}  // namespace domelight::reproject_detail
