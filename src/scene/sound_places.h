#pragma once

#include "domelight/scene/scene.h"

namespace domelight {

/// Coordinates (metres) of this size and more count as broken: the squared length of a triangle's normal would leave
/// the range of float.
inline constexpr float k_largest_coordinate = 1e9f;

/// Whether all coordinates are finite and below k_largest_coordinate.
bool is_sound(const Vec3f& p);
bool is_sound(const Affine& a);

/// Whether rays may be turned into the frame of `to_world` and stay finite there: it neither flattens nor shrinks
/// without measure.
bool has_sound_inverse(const Affine& to_world);

/// The box round a mesh, which has vertices, after `to_world`.
Scene::Box box_of(const Mesh& mesh, const Affine& to_world);
/// The smallest box round two.
Scene::Box united(const Scene::Box& a, const Scene::Box& b);
/// The box round `box` after `to_world`.
Scene::Box placed(const Scene::Box& box, const Affine& to_world);

}  // namespace domelight
