#pragma once

#include "filtering/harmonic/bright_texels.h"
#include "filtering/harmonic/spectrum.h"
#include "projection/bordered_cube.h"

#include <cstddef>
#include <cstdint>

namespace domelight {

/// Spherical-harmonic coefficients of a cube's bilinear reconstruction (BorderedCube), in the cube's own frame.
///
/// Every patch between texel centres becomes the point lights of a Gauss-Legendre rule, and each of these is spread
/// over the rings with the weights that interpolation from them would use: sum_p w_p f_p Y(d_p) with Y(d_p) = sum_grid
/// tap Y(grid).
Spectrum analyse_cube(const BorderedCube& cube, int band_limit, int threads);

/// The brightest texels as point lights: as BrightTexels::points for a lat-long image.
///
/// least_share   a texel's least part of the total power
/// most          texels that are taken, the strongest first
PointLights bright_points(const BorderedCube& cube, const Vec3d& mean, int band_limit,
                          double least_share = k_least_share, std::size_t most = SIZE_MAX);

}  // namespace domelight
