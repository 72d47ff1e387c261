// Modified Phong, rho_d / pi + rho_s (n + 2) / 2 pi cos^n, under two prefiltered maps: Miller and Hoffman 1984. The
// diffuse map is looked up by the normal, the specular one by the mirror direction, with n = v = r. So the loss of the
// BRDF at grazing angles, where half of its lobe is below the horizon, is ignored.

#include "render/shading/shading_models.h"

namespace domelight {

ShadedLight shade_phong(const SurfacePoint& s, const Vec3f& V, float occlusion, const LightAt& maps,
                        const ShadingOptions& o) {
    const Bsdf& b = s.bsdf;
    ShadedLight light;
    light.diffuse = product(b.diffuse, diffuse_irradiance_over_pi(s.normal, maps, o)) * occlusion;
    if (b.kind != Bsdf::Kind::lambert)
        light.specular = product(b.f0, maps.phong(reflect_about(V, s.normal), b.exponent)) * occlusion;
    return light;
}

}  // namespace domelight
