#pragma once

#include "base/interpolation_taps.h"

#include <cstddef>
#include <vector>

namespace domelight::simd {

/// Interpolation weights at 513 positions between two samples, in the layouts that the lookup needs.
struct TapTable {
    static constexpr int k_steps = 512;
    explicit TapTable(const InterpolationTaps& taps);  ///< of 8 taps
    std::vector<float> across;  ///< [k_steps + 1][8 x 4]: along a row, each weight four times (R, G, B, unused)
    std::vector<float> down;    ///< [k_steps + 1][8]: over rows
};

/// A function on rings of latitude with its surroundings: `rgbx` points at ring 0, column 0; columns -4 .. width + 7
/// and rings -4 .. rings + 3 exist.
struct GridView {
    const float* rgbx;
    std::ptrdiff_t stride;  ///< floats from ring to ring
    int rings, width;
};

/// Values at `count` directions (need not be of unit length): 8 x 8 taps in colatitude and azimuth from +X towards +Z.
/// out: RGB.
void lookup_directions(const GridView& grid, const TapTable& table, const double* x, const double* y, const double* z,
                       int count, float* out);

/// The same at four directions for each one given: the direction itself and the direction turned by one, two and three
/// quarter turns from +X towards +Z. If the width of the grid is a multiple of four, their weights are the same.
void lookup_quarter_turns(const GridView& grid, const TapTable& table, const double* x, const double* y,
                          const double* z, int count, float* const (&out)[4]);

/// The lookup's transpose: adds each direction's value (RGB) to the 8 x 8 grid points around it with the lookup's
/// weights. `rgbx` as in GridView.
void scatter_directions(const GridView& grid, float* rgbx, const TapTable& table, const double* x, const double* y,
                        const double* z, int count, const float* rgb);

}  // namespace domelight::simd
