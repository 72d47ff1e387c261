#pragma once
// The C++ twins of what engines' shaders do with a bake's maps: one function each.

#include "domelight/shading.h"

#include "render/surface.h"

namespace domelight {

/// Light by lobe.
struct ShadedLight {
    Vec3f diffuse, specular;
};

/// V: towards the viewer, in the world. occlusion: of the material's texture, 1 without.
ShadedLight shade_split_sum(const SurfacePoint& s, const Vec3f& V, float occlusion, const LightMaps& maps,
                            const ShadingOptions& options);
ShadedLight shade_phong(const SurfacePoint& s, const Vec3f& V, float occlusion, const LightMaps& maps,
                        const ShadingOptions& options);
ShadedLight shade_mirror(const SurfacePoint& s, const Vec3f& V, const EnvironmentSampler& environment);
ShadedLight shade_refract(const SurfacePoint& s, const Vec3f& V, float ior, const EnvironmentSampler& environment);

}  // namespace domelight
