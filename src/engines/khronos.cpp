#include "engines/all.h"

namespace domelight {

/// The Khronos glTF viewer: KTX2 cubes of 256^2 down to 16^2, one filtered with GGX and one with Charlie, read at level
/// = roughness (levels - 1); a Lambertian cube of E / pi; a table of (scale, bias, Charlie) with u = NdotV, v =
/// roughness. File names as in its sample environments. It looks along the world direction itself, so its cubes are
/// ours.
Engine khronos_engine() {
    Engine e;
    e.name = "khronos";
    e.loads = "the Khronos glTF viewer: KTX2 cubes for GGX, Charlie and Lambert (E / pi)";
    e.size = 256;
    e.smallest = 16;
    e.roughness = linear_roughness;
    e.level_text = "M r";
    e.specular_file = "ggx/specular";
    e.sheen_file = "charlie/sheen";
    e.irradiance_file = "lambertian/diffuse";
    e.irradiance_size = 256;
    e.irradiance_quantity = Quantity::irradiance_over_pi;
    e.brdf_form = BrdfForm::scale_bias_charlie;
    return e;
}

}  // namespace domelight
