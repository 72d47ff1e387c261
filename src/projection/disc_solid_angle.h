#pragma once

#include "domelight/projection/projections.h"

#include <functional>

namespace domelight {

/// Solid angle of the part inside the unit disc of a box of its picture, for a projection in which a point at distance
/// r from the middle shows a direction at the angle rho(r) from the centre's: by Green's theorem the closed integral of
/// (1 - cos rho) dphi around the part. `cap(r)` is 1 - cos rho(r), which near the middle goes as r^2.
double disc_solid_angle(const UVBox& box, const std::function<double(double r)>& cap);

}  // namespace domelight
