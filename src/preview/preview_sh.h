#pragma once

#include "domelight/vec.h"

#include <span>
#include <vector>

namespace domelight {

/// E / pi as a small lat-long picture (RGB, rows x 2 rows), from radiance coefficients in the order and basis of
/// spherical_harmonics.h. Negative lobes are kept. Bands from the 17th on are left out.
std::vector<Vec3d> sh_irradiance_picture(std::span<const Vec3d> radiance, int rows);

}  // namespace domelight
