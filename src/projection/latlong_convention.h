#pragma once

#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/projection/projections.h"

#include <string>
#include <vector>

namespace domelight {

/// The orientation of a lat-long image in the world, and the positions of its samples (docs/conventions.md).
struct LatlongConvention {
    using Grid = SampleGrid;
    Vec3d centre{1, 0, 0};  ///< world direction at the image's centre
    Vec3d right{0, 0, 1};   ///< a quarter turn to the right of it
    Vec3d up{0, 1, 0};      ///< at the top row
    Grid grid = Grid::centres;

    /// Maps a world direction to the direction at which the default convention shows the same point of the image.
    /// Orthogonal; mirrors where right = -(centre x up).
    Mat3 world_to_default() const { return {{centre, up, right}}; }
};

/// The conventions that have names: "default", "usd", "mitsuba", ...
std::vector<std::string> latlong_convention_names();
/// One of these, or "centre=+X,right=+Z[,up=+Y]" of signed axes. The error of any other name lists them.
Result<LatlongConvention> latlong_convention(const std::string& name);

/// "+X", "x", "-z", ...
Result<Vec3d> signed_axis(const std::string& name);

}  // namespace domelight
