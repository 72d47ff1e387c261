// Split-sum: Karis 2013, "Real Shading in Unreal Engine 4". docs/math/split-sum.md derives it line by line.

#include "render/shading/shading_models.h"

namespace domelight {
namespace {

/// Specular occlusion from the ambient one: Lagarde and de Rousiers 2014, "Moving Frostbite to PBR", listing 26.
float specular_occlusion(float NdotV, float occlusion, float alpha) {
    return std::clamp(std::pow(NdotV + occlusion, std::exp2(-16 * alpha - 1)) - 1 + occlusion, 0.f, 1.f);
}

/// The lookup direction: the mirror direction, or a direction between it and the normal, which is nearer to the normal
/// the rougher the surface is (the same, listing 21).
Vec3f lookup_direction(const Vec3f& N, const Vec3f& V, float roughness, bool bent) {
    const Vec3f R = reflect_about(V, N);
    if (!bent) return R;
    const float smooth = 1 - roughness, lean = smooth * (std::sqrt(smooth) + roughness);
    return N + (R - N) * lean;
}

}  // namespace

Vec3f diffuse_weight_fresnel(const Vec3f& f0, const Vec3f& f90, float NdotV) {
    return Vec3f{1, 1, 1} - fresnel_schlick(NdotV, f0, f90);
}

Vec3f diffuse_weight_energy(const Vec3f& f0, const Vec3f& f90, LightAt::ScaleBias table) {
    return Vec3f{1, 1, 1} - (f0 * table.scale + f90 * table.bias);
}

Vec3f multiple_scattering(const Vec3f& f0, const Vec3f& f90, LightAt::ScaleBias table) {
    const Vec3f single = f0 * table.scale + f90 * table.bias;
    const float lost = 1 - (table.scale + table.bias);
    const auto channel = [&](float f, float once) {
        const float mean = f + (1 - f) / 21;  // Schlick's F, averaged over the cosine
        return lost * once * mean / (1 - lost * mean);
    };
    return {channel(f0.x, single.x), channel(f0.y, single.y), channel(f0.z, single.z)};
}

ShadedLight shade_metallic_roughness(const SurfacePoint& s, float NdotV, float occlusion, const LobeLight& lobe,
                                     const LightAt& maps, const ShadingOptions& o) {
    const Bsdf& b = s.bsdf;
    const Vec3f E = diffuse_irradiance_over_pi(s.normal, maps, o);
    const LightAt::ScaleBias table = maps.brdf(NdotV, std::sqrt(b.alpha));
    ShadedLight light;
    light.specular = product(lobe.scale, b.f0 * table.scale) + product(lobe.bias, b.f90 * table.bias);
    Vec3f weight = o.diffuse_weight == DiffuseWeight::fresnel ? diffuse_weight_fresnel(b.f0, b.f90, NdotV)
                                                              : diffuse_weight_energy(b.f0, b.f90, table);
    if (o.multiple_scattering) {
        const Vec3f multiple = multiple_scattering(b.f0, b.f90, table);
        light.specular += product(multiple, E);
        if (o.diffuse_weight == DiffuseWeight::energy) weight = weight - multiple;
    }
    light.diffuse = product(product(b.diffuse, weight), E) * occlusion;
    light.specular *= specular_occlusion(NdotV, occlusion, b.alpha);
    return light;
}

ShadedLight shade_split_sum(const SurfacePoint& s, const Vec3f& V, float occlusion, const LightAt& maps,
                            const ShadingOptions& o) {
    const Bsdf& b = s.bsdf;
    if (b.kind == Bsdf::Kind::lambert)
        return {product(b.diffuse, diffuse_irradiance_over_pi(s.normal, maps, o)) * occlusion, {}};
    const float NdotV = std::clamp(dot(s.normal, V), 0.f, 1.f), roughness = std::sqrt(b.alpha);
    const Vec3f light = maps.specular(lookup_direction(s.normal, V, roughness, o.bent_lookup), roughness);
    return shade_metallic_roughness(s, NdotV, occlusion, {light, light}, maps, o);
}

}  // namespace domelight
