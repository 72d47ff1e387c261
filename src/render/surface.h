#pragma once

#include "domelight/frame.h"

#include "render/bsdf.h"
#include "render/ray_scene.h"

namespace domelight {

/// All that shading needs to know of a point of a surface.
struct SurfacePoint {
    Vec3f position;
    Vec3f normal;            ///< of the surface as lit (interpolated, normal-mapped), unit length, on the viewer's side
    Vec3f geometric_normal;  ///< of the triangle, unit length, on the viewer's side
    Vec3f emission;
    Vec3f albedo;       ///< for the albedo layer
    float opacity = 1;  ///< below 1: the ray goes on with 1 - opacity of its weight
    bool unlit = false;
    bool front = true;
    float error = 0;  ///< how far from the surface a ray must start
    Bsdf bsdf;
};

/// Interpolates, reads textures, and makes the BRDF. `direction`: of the ray that hit, unit length.
SurfacePoint surface_at(const Scene& scene, const Hit& hit, const Vec3f& origin, const Vec3f& direction,
                        bool multiple_scattering);

/// A surface's opacity where a ray met it, [0, 1].
float opacity_at(const Scene& scene, const Hit& hit);
/// What the occlusion texture says there, [0, 1]; 1 without one.
float occlusion_at(const Scene& scene, const Hit& hit);
/// Whether any material of the scene can let rays through, so that occlusion needs more than a yes or no.
bool has_passages(const Scene& scene);

}  // namespace domelight
