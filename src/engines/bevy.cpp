#include "engines/all.h"

namespace domelight {

/// Bevy's EnvironmentMapLight: two KTX2 cubes in RGB9E5 with zstd, the diffuse one 32^2 of E / pi, the specular one
/// 512^2, read at level = roughness (levels - 1). Its shaders negate z before they look the cube up, so the cubes are
/// mirrored in z. Radiance in cd/m^2 is a matter of the light's intensity there.
Engine bevy_engine() {
    Engine e;
    e.name = "bevy";
    e.loads = "Bevy: KTX2 cubes, RGB9E5 with zstd (EnvironmentMapLight)";
    e.roughness = linear_roughness;
    e.level_text = "M r";
    e.mirror = CubeMirror::z;
    e.encoding = Encoding::rgb9e5;
    e.zstd = true;
    e.specular_file = "{stem}_specular";
    e.irradiance_file = "{stem}_diffuse";
    e.irradiance_size = 32;
    e.irradiance_quantity = Quantity::irradiance_over_pi;
    e.irradiance_encoding = Encoding::rgb9e5;
    e.brdf_file = "";
    e.brdf_form = BrdfForm::none;
    return e;
}

}  // namespace domelight
