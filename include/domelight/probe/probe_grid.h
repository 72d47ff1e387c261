#pragma once

#include "domelight/base/vec.h"

#include <array>

namespace domelight {

/// Places in a regular grid along the axes of the world. Number i = x + nx (y + ny z) is the place in column x, layer
/// y and row z.
struct ProbeGrid {
    Vec3f origin{};          ///< place 0, metres
    Vec3f spacing{1, 1, 1};  ///< from place to place, metres, each > 0
    int nx = 1, ny = 1, nz = 1;

    int count() const { return nx * ny * nz; }
    int index(int x, int y, int z) const { return x + nx * (y + ny * z); }
    Vec3f place(int i) const {
        const int x = i % nx, y = i / nx % ny, z = i / (nx * ny);
        return origin + Vec3f{float(x) * spacing.x, float(y) * spacing.y, float(z) * spacing.z};
    }
};

/// The eight places around a point, and the weights with which to interpolate between them.
struct GridCell {
    std::array<int, 8> place;     ///< numbers in the grid; several are the same on an axis with one place
    std::array<float, 8> weight;  ///< trilinear, >= 0; their sum is 1
};

/// The cell that the point lies in. A point outside the grid is first moved to the nearest point of the grid's box.
GridCell cell_at(const ProbeGrid& grid, const Vec3f& point);

}  // namespace domelight
