#pragma once

#include "domelight/render/render.h"

#include <limits>
#include <span>
#include <vector>

namespace domelight {

/// Which surfaces have a back.
enum class Backs {
    single_sided,  ///< those whose material is not double-sided
    all,           ///< double-sided ones too: the side from which their corners run clockwise
};

/// What rays from a point meet.
struct Surroundings {
    float backs = 0;     ///< the share of the rays that meet the back of a surface
    float surfaces = 0;  ///< the share that meet a surface at all
    float front_distance = std::numeric_limits<float>::infinity();
    Vec3f to_front;  ///< towards the nearest front, unit length

    /// More than a quarter of the rays meet backs: the point lies inside a body.
    bool inside() const { return backs > 0.25f; }
};

/// directions   of the rays, unit length
Surroundings look_around(const RayScene& scene, const Vec3f& from, std::span<const Vec3f> directions,
                         Backs backs = Backs::single_sided);

/// The nearest surface along a ray.
struct SurfaceAlong {
    float distance = std::numeric_limits<float>::infinity();  ///< infinite: there is none
    Vec3f normal;                                             ///< of unit length
};
SurfaceAlong surface_along(const RayScene& scene, const Vec3f& from, const Vec3f& direction);

/// How many surfaces lie between two points; counted up to `most`.
int surfaces_between(const RayScene& scene, const Vec3f& from, const Vec3f& to, int most);

}  // namespace domelight
