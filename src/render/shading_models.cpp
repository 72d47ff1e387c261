#include "render/shading_models.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

Vec3f irradiance(const Vec3f& N, const LightMaps& maps, const ShadingOptions& o) {
    return o.sh_irradiance ? maps.irradiance_over_pi_sh(N) : maps.irradiance_over_pi(N);
}

/// Specular occlusion from the ambient one: Lagarde and de Rousiers 2014, "Moving Frostbite to PBR", listing 26.
float specular_occlusion(float NdotV, float occlusion, float alpha) {
    return std::clamp(std::pow(NdotV + occlusion, std::exp2(-16 * alpha - 1)) - 1 + occlusion, 0.f, 1.f);
}

}  // namespace

ShadedLight shade_split_sum(const SurfacePoint& s, const Vec3f& V, float occlusion, const LightMaps& maps,
                            const ShadingOptions& o) {
    const Bsdf& b = s.bsdf;
    const Vec3f E = irradiance(s.normal, maps, o);
    if (b.kind == Bsdf::Kind::lambert) return {product(b.diffuse, E) * occlusion, {}};
    const float NdotV = std::clamp(dot(s.normal, V), 0.f, 1.f), roughness = std::sqrt(b.alpha);
    Vec3f R = reflect_about(V, s.normal);
    if (o.bent_lookup) {
        // listing 21: the lobe leans to the normal the more the rougher it is
        const float smooth = 1 - roughness, lean = smooth * (std::sqrt(smooth) + roughness);
        R = s.normal + (R - s.normal) * lean;
    }
    const auto [scale, bias] = maps.brdf(NdotV, roughness);
    const Vec3f single = b.f0 * scale + b.f90 * bias;
    ShadedLight light;
    light.specular = product(maps.specular(R, roughness), single);
    const Vec3f F = fresnel_schlick(NdotV, b.f0, b.f90);
    Vec3f below = b.diffuse * (1 - std::max({F.x, F.y, F.z}));  // kD (1 - metalness) c, the metalness in b.diffuse
    if (o.multiple_scattering) {
        // Fdez-Aguera 2019, listing 2: what single scattering loses comes back as cosine-weighted light.
        const float lost = 1 - (scale + bias);
        const auto channel = [&](float f0, float f) {
            const float mean = f0 + (1 - f0) / 21;
            return lost * f * mean / (1 - lost * mean);
        };
        const Vec3f multiple{channel(b.f0.x, single.x), channel(b.f0.y, single.y), channel(b.f0.z, single.z)};
        const Vec3f rest = Vec3f{1, 1, 1} - (single + multiple);
        light.specular = light.specular + product(multiple, E);
        below = {b.diffuse.x * rest.x, b.diffuse.y * rest.y, b.diffuse.z * rest.z};
    }
    light.diffuse = product(below, E) * occlusion;
    light.specular = light.specular * specular_occlusion(NdotV, occlusion, b.alpha);
    return light;
}

ShadedLight shade_phong(const SurfacePoint& s, const Vec3f& V, float occlusion, const LightMaps& maps,
                        const ShadingOptions& o) {
    const Bsdf& b = s.bsdf;
    ShadedLight light{product(b.diffuse, irradiance(s.normal, maps, o)) * occlusion, {}};
    // The map is a GGX chain: looked up at the roughness whose exponent it is.
    light.specular = product(maps.specular(reflect_about(V, s.normal), std::sqrt(b.alpha)), b.f0) * occlusion;
    return light;
}

ShadedLight shade_mirror(const SurfacePoint& s, const Vec3f& V, const EnvironmentSampler& environment) {
    return {{}, environment.radiance(reflect_about(V, s.normal))};
}

ShadedLight shade_refract(const SurfacePoint& s, const Vec3f& V, float ior, const EnvironmentSampler& environment) {
    const float NdotV = std::clamp(dot(s.normal, V), 0.f, 1.f), eta = s.front ? 1 / ior : ior;
    // Snell: sin t = eta sin i; beyond the critical angle all is reflected.
    const float cos2 = 1 - eta * eta * (1 - NdotV * NdotV), f0 = (ior - 1) / (ior + 1) * ((ior - 1) / (ior + 1));
    const float mix = cos2 > 0 ? f0 + (1 - f0) * schlick_weight(NdotV) : 1;
    Vec3f light = environment.radiance(reflect_about(V, s.normal)) * mix;
    if (mix < 1) light = light + environment.radiance(s.normal * (eta * NdotV - std::sqrt(cos2)) - V * eta) * (1 - mix);
    return {{}, light};
}

}  // namespace domelight
