#pragma once

#include "filtering/resample/reproject_source.h"

#include <array>
#include <functional>
#include <vector>

namespace domelight::reproject_detail {

/// The largest number of texels on a block's side.
constexpr int k_tile = 16;

struct SourcePoint {
    double x = 0, y = 0;
};
/// The source position of a point (x, y) in texels of the target's chart.
using PlaceOf = std::function<SourcePoint(double x, double y)>;

/// A block of target texels that is integrated by outlines: its grid of nx x ny texel corners.
struct Block {
    int chart = 0, x0 = 0, y0 = 0;  ///< the first corner in the target
    int nx = 0, ny = 0;
    Place first;  ///< of the first corner; all others lie in its chart and region
    /// The corners' places in the source, row by row. In a picture that wraps, x is near `first`.
    std::array<double, std::size_t(k_tile + 1) * (k_tile + 1)> x, y;
    double least_x = 0, least_y = 0, most_x = 0, most_y = 0;  ///< of the corners
    int parts = 1;  ///< the number of straight parts that a texel's side is approximated by

    std::size_t corner(int i, int j) const { return std::size_t(j) * nx + i; }
};

/// ∫ G dy along a side (TileIntegrator): the light's three channels and the solid angle.
using SideSum = std::array<double, 4>;

/// The integrals along all sides of a block's texels.
struct SideSums {
    std::vector<SideSum> across;  ///< from corner (i, j) to (i + 1, j): entry j (nx - 1) + i
    std::vector<SideSum> down;    ///< from corner (i, j) to (i, j + 1): entry j nx + i
};

/// The rectangle of source texels that a block's outlines may touch.
struct SourceBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    /// Whether it has so many texels that another method is faster.
    bool too_large() const { return width() <= 0 || height() <= 0 || std::int64_t(width()) * height() > 40000; }
};
SourceBox source_box(const Block& block);

}  // namespace domelight::reproject_detail
