// Split-sum: Karis 2013, "Real Shading in Unreal Engine 4". docs/math/split-sum.md derives it line by line.

#include "render/shading/shading_models.h"

namespace domelight {
namespace {

/// Specular occlusion from the ambient one: Lagarde and de Rousiers 2014, "Moving Frostbite to PBR", listing 26.
float specular_occlusion(float NdotV, float occlusion, float alpha) {
    return std::clamp(std::pow(NdotV + occlusion, std::exp2(-16 * alpha - 1)) - 1 + occlusion, 0.f, 1.f);
}

/// Where to look up: the mirror direction, or on its way to the normal, further the rougher the surface is (the same,
/// listing 21).
Vec3f lookup_direction(const Vec3f& N, const Vec3f& V, float roughness, bool bent) {
    const Vec3f R = reflect_about(V, N);
    if (!bent) return R;
    const float smooth = 1 - roughness, lean = smooth * (std::sqrt(smooth) + roughness);
    return N + (R - N) * lean;
}

/// What single scattering loses, given back as cosine-weighted light: Fdez-Aguera 2019, listing 2, one channel.
float multiple_scattering(float f0, float single, float lost) {
    const float mean = f0 + (1 - f0) / 21;  // Schlick's F, averaged over the cosine
    return lost * single * mean / (1 - lost * mean);
}

}  // namespace

ShadedLight shade_metallic_roughness(const SurfacePoint& s, float NdotV, float occlusion, const LobeLight& lobe,
                                     const LightMaps& maps, const ShadingOptions& o) {
    const Bsdf& b = s.bsdf;
    const Vec3f E = diffuse_irradiance_over_pi(s.normal, maps, o);
    const auto [scale, bias] = maps.brdf(NdotV, std::sqrt(b.alpha));
    ShadedLight light;
    light.specular = product(lobe.scale, b.f0 * scale) + product(lobe.bias, b.f90 * bias);
    const Vec3f F = fresnel_schlick(NdotV, b.f0, b.f90);
    Vec3f below = b.diffuse * (1 - std::max({F.x, F.y, F.z}));  // kD (1 - metalness) c, the metalness in b.diffuse
    if (o.multiple_scattering) {
        const Vec3f single = b.f0 * scale + b.f90 * bias;
        const float lost = 1 - (scale + bias);
        const Vec3f multiple{multiple_scattering(b.f0.x, single.x, lost), multiple_scattering(b.f0.y, single.y, lost),
                             multiple_scattering(b.f0.z, single.z, lost)};
        light.specular = light.specular + product(multiple, E);
        below = product(b.diffuse, Vec3f{1, 1, 1} - (single + multiple));
    }
    light.diffuse = product(below, E) * occlusion;
    light.specular = light.specular * specular_occlusion(NdotV, occlusion, b.alpha);
    return light;
}

ShadedLight shade_split_sum(const SurfacePoint& s, const Vec3f& V, float occlusion, const LightMaps& maps,
                            const ShadingOptions& o) {
    const Bsdf& b = s.bsdf;
    if (b.kind == Bsdf::Kind::lambert)
        return {product(b.diffuse, diffuse_irradiance_over_pi(s.normal, maps, o)) * occlusion, {}};
    const float NdotV = std::clamp(dot(s.normal, V), 0.f, 1.f), roughness = std::sqrt(b.alpha);
    const Vec3f light = maps.specular(lookup_direction(s.normal, V, roughness, o.bent_lookup), roughness);
    return shade_metallic_roughness(s, NdotV, occlusion, {light, light}, maps, o);
}

}  // namespace domelight
