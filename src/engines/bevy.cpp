#include "engines/all.h"

namespace domelight {

/// Bevy's EnvironmentMapLight: two KTX2 cubes in RGB9E5 with zstd, the diffuse one 32^2 of E / pi, the specular one
/// 512^2, read at level = roughness (levels - 1). Its shaders negate z before they look the cube up, so the cubes are
/// mirrored in z. Radiance in cd/m^2 is a matter of the light's intensity there.
Target bevy_target() {
    Target t;
    t.name = "bevy";
    t.consumer = "Bevy: KTX2 cubes, RGB9E5 with zstd (EnvironmentMapLight)";
    t.roughness = linear_roughness;
    t.mirror = CubeMirror::z;
    t.encoding = Encoding::rgb9e5;
    t.zstd = true;
    t.specular_file = "{stem}_specular";
    t.irradiance_file = "{stem}_diffuse";
    t.irradiance_size = 32;
    t.irradiance_quantity = Quantity::irradiance_over_pi;
    t.irradiance_encoding = Encoding::rgb9e5;
    t.brdf_file = "";
    t.brdf_form = BrdfForm::none;
    return t;
}

}  // namespace domelight
