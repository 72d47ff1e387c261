#pragma once

#include "filtering/harmonic/ring_analysis.h"
#include "filtering/harmonic/sphere_grid.h"
#include "filtering/lights/point_lights.h"

#include <vector>

namespace domelight {

/// Analysis of a function that is a sum of points. Each point is spread over the rings of a grid with the weights that
/// interpolation from them would use (simd::scatter_directions): sum_p w_p f_p Y(d_p) with Y(d_p) = sum_grid tap Y(grid).
class ScatterAnalysis {
  public:
    /// with   a grid_transform()
    explicit ScatterAnalysis(std::shared_ptr<const RingTransform> with);

    const RingGrid& grid() const { return rings_.grid(); }
    const simd::TapTable& table() const { return *table_; }
    /// Once, with the grids over which the points were spread. It changes them.
    Spectrum finish(std::vector<SphereGrid>& grids, int threads);

  private:
    RingAnalysis rings_;
    std::shared_ptr<const simd::TapTable> table_;
};

/// Spherical-harmonic coefficients of point lights. with: a grid_transform().
Spectrum analyse_lights(const PointLights& lights, std::shared_ptr<const RingTransform> with, int threads);

}  // namespace domelight
