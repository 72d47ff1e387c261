// Refraction mapping: the sharp environment in the direction refracted once, at the front surface, mixed with the
// reflection.

#include "render/shading/shading_models.h"

namespace domelight {

ShadedLight shade_refract(const SurfacePoint& s, const Vec3f& V, float ior, const EnvironmentMap& environment) {
    const float NdotV = std::clamp(dot(s.normal, V), 0.f, 1.f), eta = s.front ? 1 / ior : ior;
    // Snell: sin t = eta sin i; beyond the critical angle all is reflected.
    const float cos2 = 1 - eta * eta * (1 - NdotV * NdotV), f0 = (ior - 1) / (ior + 1) * ((ior - 1) / (ior + 1));
    const float mix = cos2 > 0 ? f0 + (1 - f0) * schlick_weight(NdotV) : 1;
    Vec3f light = environment.radiance(reflect_about(V, s.normal)) * mix;
    if (mix < 1) light += environment.radiance(s.normal * (eta * NdotV - std::sqrt(cos2)) - V * eta) * (1 - mix);
    return {{}, light};
}

}  // namespace domelight
