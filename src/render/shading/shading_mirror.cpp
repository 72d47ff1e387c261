// Reflection mapping: Blinn and Newell 1976. The sharp environment in the mirror direction, whatever the material.

#include "render/shading/shading_models.h"

namespace domelight {

ShadedLight shade_mirror(const SurfacePoint& s, const Vec3f& V, const EnvironmentMap& environment) {
    return {{}, environment.radiance(reflect_about(V, s.normal))};
}

}  // namespace domelight
