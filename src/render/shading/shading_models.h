#pragma once
// The shaders of engines that use a bake's maps, written in C++: one function for each model, each in its own file.

#include "domelight/render/shading/shading.h"

#include "render/environment_map.h"
#include "render/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace domelight {

/// Light, by lobe.
struct ShadedLight {
    Vec3f diffuse, specular;
};

/// V: towards the viewer, in the world. occlusion: from the material's texture, 1 without one.
ShadedLight shade_split_sum(const SurfacePoint& s, const Vec3f& V, float occlusion, const LightAt& maps,
                            const ShadingOptions& options);
ShadedLight shade_stretched(const SurfacePoint& s, const Vec3f& V, float occlusion, const LightAt& maps,
                            const ShadingOptions& options);
ShadedLight shade_phong(const SurfacePoint& s, const Vec3f& V, float occlusion, const LightAt& maps,
                        const ShadingOptions& options);
ShadedLight shade_mirror(const SurfacePoint& s, const Vec3f& V, const EnvironmentMap& environment);
ShadedLight shade_refract(const SurfacePoint& s, const Vec3f& V, float ior, const EnvironmentMap& environment);

/// The light of punctual lights, which every model adds to that of its maps: the sum over the lights of f E cos. f is
/// the material's BRDF; of phong its Phong lobe; of mirror and refract a narrow GGX highlight, with the reflectance 1
/// and that of `ior`. Occlusion textures have no say: they are about light from all around.
ShadedLight shade_lights(ShadingModel model, const SurfacePoint& s, const Vec3f& V, float ior,
                         std::span<const PunctualLight> lights);

// Functions shared by several models:

/// Scale and bias from a BRDF table, bilinear: NdotV to the right and roughness down.
LightAt::ScaleBias look_up_brdf(const ImageF& table, float NdotV, float roughness);
/// The roughness that corresponds to an exponent by Beckmann's relation n = 2 / alpha^2 - 2: a coordinate in which the
/// levels of a Phong chain are about evenly spaced; exponent infinity has roughness 0, exponent 0 has roughness 1.
float matching_roughness(double exponent);

/// Means of the light over the specular lobe: weighted by the part of the lobe that is multiplied by F0, and by the
/// part that is multiplied by F90.
struct LobeLight {
    Vec3f scale, bias;
};
/// DiffuseWeight::fresnel: 1 - F(NdotV).
Vec3f diffuse_weight_fresnel(const Vec3f& f0, const Vec3f& f90, float NdotV);
/// DiffuseWeight::energy: 1 - (F0 scale + F90 bias).
Vec3f diffuse_weight_energy(const Vec3f& f0, const Vec3f& f90, LightAt::ScaleBias table);
/// The share of an even light that reaches the viewer after more than one bounce between the microfacets. Fdez-Aguera
/// 2019, listing 2.
Vec3f multiple_scattering(const Vec3f& f0, const Vec3f& f90, LightAt::ScaleBias table);

/// The metallic-roughness surface for a given specular light: BRDF table, weight of the diffuse layer, multiple
/// scattering, occlusion.
ShadedLight shade_metallic_roughness(const SurfacePoint& s, float NdotV, float occlusion, const LobeLight& lobe,
                                     const LightAt& maps, const ShadingOptions& options);

inline Vec3f diffuse_irradiance_over_pi(const Vec3f& N, const LightAt& maps, const ShadingOptions& o) {
    return o.sh_irradiance ? maps.irradiance_over_pi_sh(N) : maps.irradiance_over_pi(N);
}

}  // namespace domelight
