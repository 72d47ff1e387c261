#pragma once

#include "domelight/base/frame.h"

#include "render/layered_bsdf.h"
#include "render/ray_scene.h"
#include "render/surface/bsdf.h"

#include <algorithm>
#include <cmath>

namespace domelight {

/// Everything that shading needs to know about a point of a surface.
struct SurfacePoint {
    Vec3f position;
    Vec3f normal;            ///< of the surface as lit (interpolated, normal-mapped), unit length, on the viewer's side
    Vec3f geometric_normal;  ///< of the triangle, unit length, on the viewer's side
    Vec3f emission;
    Vec3f albedo;       ///< for the albedo layer
    float opacity = 1;  ///< below 1: the ray continues with 1 - opacity of its weight
    bool unlit = false;
    bool front = true;
    float error = 0;                      ///< the distance from the surface at which a ray must start
    Bsdf bsdf;                            ///< of the base, which is everything for most materials
    const LayeredBsdf* layers = nullptr;  ///< used instead of it if the material has layers

    /// f times the cosine; L.z > 0 unless there are layers.
    Bsdf::Value evaluate_cosine(const Vec3f& V, const Vec3f& L) const {
        if (layers) return layers->evaluate_cosine(V, L);
        const Bsdf::Value f = bsdf.evaluate(V, L);
        return {f.diffuse * L.z, f.specular * L.z};
    }
    /// No light can go in this direction, because it would have to pass the surface.
    bool blocks(const Vec3f& direction) const { return !layers && dot(direction, geometric_normal) <= 0; }
    /// A ray that starts just outside the surface, on the side of its direction.
    Ray ray_to(const Vec3f& direction) const {
        return {position + geometric_normal * (dot(direction, geometric_normal) >= 0 ? error : -error), direction};
    }
    /// The same to a point of another surface, or to infinity. It ends just before the point, so that rounding does not
    /// make that surface occlude itself: 1e-5 of the way and the error of the start.
    Ray ray_to(const Vec3f& direction, float distance) const {
        Ray ray = ray_to(direction);
        if (std::isinf(distance)) return ray;
        // From the shifted start, or it would meet a surface that it grazes elsewhere.
        const Vec3f to = position + direction * distance - ray.origin;
        const float length = std::sqrt(dot(to, to));
        if (length > 0) ray.direction = to / length;
        ray.far = std::max(0.f, length * (1 - 1e-5f) - error);
        return ray;
    }
    float pdf_solid_angle(const Vec3f& V, const Vec3f& L) const {
        return layers ? layers->pdf_solid_angle(V, L) : bsdf.pdf_solid_angle(V, L);
    }
};

/// Interpolates, reads textures, and makes the BRDF. `direction`: of the ray, unit length. `layers`: receives the
/// layers that are not part of glTF's core; null: they are left out. `shift`: a random point for interface_albedo().
SurfacePoint surface_at(const Scene& scene, const Hit& hit, const Vec3f& origin, const Vec3f& direction,
                        bool multiple_scattering, LayeredBsdf* layers = nullptr, UnitPoint shift = {});

/// The radiance that a surface emits where a ray met it, in all directions alike: before the layers over it take a part.
Vec3f emission_before_layers(const Scene& scene, const Hit& hit);
/// The emission of surface_at() alone.
Vec3f emission_at(const Scene& scene, const Hit& hit, const Vec3f& origin, const Vec3f& direction,
                  bool multiple_scattering);

/// A surface's opacity where a ray met it, [0, 1].
float opacity_at(const Scene& scene, const Hit& hit);
/// The value of the occlusion texture there, [0, 1]; 1 without one.
float occlusion_at(const Scene& scene, const Hit& hit);
/// Whether any material of the scene can be transparent, so that occlusion is more than a yes or no.
bool has_passages(const Scene& scene);

}  // namespace domelight
