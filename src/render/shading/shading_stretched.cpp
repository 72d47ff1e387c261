// One step beyond split-sum: the lobe is stretched like that of the BRDF, by up to eight more lookups in the same
// chain.

#include "render/shading/shading_models.h"
#include "render/shading/stretched_lobe.h"

namespace domelight {
namespace {

/// The lobe's light, by a row of lookups in the plane of incidence.
LobeLight stretched_light(const Vec3f& N, const Vec3f& V, float NdotV, float roughness, const LightAt& maps) {
    const Vec3f R = reflect_about(V, N), across = R - N * dot(N, R);
    const float sine = length(across);
    // From R towards N, in the plane of both. Seen from straight above all tilts are 0, and any direction is right.
    const Vec3f up = sine > 0 ? N * sine - across * (dot(N, R) / sine) : Vec3f{};
    LobeLight light;
    for (const StretchedTap& tap : stretched_taps(NdotV, roughness)) {
        const Vec3f L =
            maps.specular(R * float(std::cos(tap.tilt)) + up * float(std::sin(tap.tilt)), float(tap.roughness));
        light.scale += L * float(tap.scale);
        light.bias += L * float(tap.bias);
    }
    return light;
}

}  // namespace

ShadedLight shade_stretched(const SurfacePoint& s, const Vec3f& V, float occlusion, const LightAt& maps,
                            const ShadingOptions& o) {
    const Bsdf& b = s.bsdf;
    if (b.kind == Bsdf::Kind::lambert)
        return {product(b.diffuse, diffuse_irradiance_over_pi(s.normal, maps, o)) * occlusion, {}};
    const float NdotV = std::clamp(dot(s.normal, V), 0.f, 1.f), roughness = std::sqrt(b.alpha);
    return shade_metallic_roughness(s, NdotV, occlusion, stretched_light(s.normal, V, NdotV, roughness, maps), maps, o);
}

}  // namespace domelight
