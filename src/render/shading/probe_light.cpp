#include "render/shading/probe_light.h"

#include "domelight/filtering/brdf/brdf_table.h"

#include "render/shading/shading_models.h"

namespace domelight {

Vec3f ProbeLight::phong(const Vec3f& direction, float exponent) const {
    return specular(direction, matching_roughness(exponent));
}

LightAt::ScaleBias ProbeLight::brdf(float NdotV, float roughness) const {
    return look_up_brdf(brdf_table_default(), NdotV, roughness);
}

}  // namespace domelight
