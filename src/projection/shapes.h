#pragma once
// The shapes behind domelight/projection/projections.h, one file each.

#include "domelight/projection/projections.h"

namespace domelight {

std::shared_ptr<const ProjectionShape> make_latlong_shape();
std::shared_ptr<const ProjectionShape> make_cube_shape();
std::shared_ptr<const ProjectionShape> make_sphere_map_shape();
/// normalize(p).xy: only the half with z > 0.
std::shared_ptr<const ProjectionShape> make_hemisphere_shape();
/// A mirror ball that spans `fov` radians of a camera's view, 0 <= fov < pi; 0 is the sphere map.
std::shared_ptr<const ProjectionShape> make_mirror_ball_shape(double fov);
std::shared_ptr<const ProjectionShape> make_angular_shape();
/// One half of a dual paraboloid: the one with z > 0.
std::shared_ptr<const ProjectionShape> make_paraboloid_shape();
/// The map looked up at xy / (z - 1): the half with z < 0, turned by half a turn.
std::shared_ptr<const ProjectionShape> make_paraboloid_opposite_shape();
std::shared_ptr<const ProjectionShape> make_dual_paraboloid_shape();
std::shared_ptr<const ProjectionShape> make_octahedral_shape();
std::shared_ptr<const ProjectionShape> make_equal_area_octahedral_shape();

}  // namespace domelight
