#pragma once
// Random directions at which a chain is read.

#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/environment/environment.h"
#include "domelight/filtering/kernel/zonal_kernel.h"

#include <cstdint>
#include <span>
#include <vector>

namespace domelight {

/// Half of the directions are uniform over the sphere. A quarter are drawn in proportion to the environment's light, a
/// quarter to that light filtered with lobe(): uniform directions alone would miss a sun and its surroundings.
class ReadDirections {
  public:
    /// count   at least 2
    /// Errors: those of reading the environment.
    static Result<ReadDirections> draw(const Environment& environment, int count, std::uint64_t seed, int threads);

    static ZonalKernel lobe();

    /// World directions of unit length.
    const std::vector<Vec3d>& directions() const { return directions_; }

    /// For each direction 1 / (4π density), so that weighted means are means over the sphere.
    ///
    /// filtered   the environment filtered with lobe() in each direction: RGB
    /// mean       of the environment over the sphere
    std::vector<double> weights(std::span<const float> filtered, const Vec3d& mean) const;

  private:
    std::vector<Vec3d> directions_;
    std::vector<float> light_pdf_;  ///< per steradian: with which light alone would draw each direction
};

}  // namespace domelight
