// Punctual lights on a surface as engines draw them: the material's own BRDF towards each light, without shadows.

#include "render/punctual.h"
#include "render/shading/shading_models.h"

namespace domelight {
namespace {

/// The least perceptual roughness that engines give a highlight (the value of three.js and Filament): a perfect mirror
/// would show a light that has no size as nothing at all.
constexpr float k_least_highlight_roughness = 0.045f;

/// What mirror and refract draw lights with: a glossy surface of this reflectance.
Bsdf highlight(float f0) {
    Bsdf b;
    b.kind = Bsdf::Kind::metallic_roughness;
    b.f0 = {f0, f0, f0};
    b.f90 = {1, 1, 1};
    b.alpha = k_least_highlight_roughness * k_least_highlight_roughness;
    return b;
}

Bsdf lit_bsdf(ShadingModel model, const Bsdf& material, float ior) {
    const float ratio = (ior - 1) / (ior + 1);
    switch (model) {
        case ShadingModel::split_sum:
        case ShadingModel::stretched:
            break;
        case ShadingModel::phong: {
            Bsdf phong = material;
            if (phong.kind != Bsdf::Kind::lambert) phong.kind = Bsdf::Kind::phong;
            return phong;
        }
        case ShadingModel::mirror:
            return highlight(1);
        case ShadingModel::refract:
            return highlight(ratio * ratio);
    }
    return material;
}

}  // namespace

ShadedLight shade_lights(ShadingModel model, const SurfacePoint& s, const Vec3f& V, float ior,
                         std::span<const PunctualLight> lights) {
    ShadedLight sum;
    if (lights.empty()) return sum;
    const Bsdf bsdf = lit_bsdf(model, s.bsdf, ior);
    const Frame<float> frame(s.normal);
    const Vec3f V_local = frame.to_local(V);
    for (const PunctualLight& light : lights) {
        const PunctualArrival arrival = arrival_at(light, s.position);
        const Vec3f L = frame.to_local(arrival.direction);
        if (arrival.strength <= 0 || L.z <= 0) continue;
        const Bsdf::Value f = bsdf.evaluate(V_local, L);
        const Vec3f irradiance = light.intensity * (arrival.strength * L.z);
        sum.diffuse += product(f.diffuse, irradiance);
        sum.specular += product(f.specular, irradiance);
    }
    return sum;
}

}  // namespace domelight
