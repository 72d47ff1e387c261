#include "engines/all.h"

namespace domelight {

/// The Khronos glTF viewer: KTX2 cubes of 256^2 down to 16^2, one filtered with GGX and one with Charlie, read at level
/// = roughness (levels - 1); a Lambertian cube of E / pi; a table of (scale, bias, Charlie) with u = NdotV, v =
/// roughness. File names as in its sample environments. It looks along the world direction itself, so its cubes are
/// ours.
Target khronos_target() {
    Target t;
    t.name = "khronos";
    t.consumer = "the Khronos glTF viewer: KTX2 cubes for GGX, Charlie and Lambert (E / pi)";
    t.size = 256;
    t.smallest = 16;
    t.roughness = linear_roughness;
    t.specular_file = "ggx/specular";
    t.sheen_file = "charlie/sheen";
    t.irradiance_file = "lambertian/diffuse";
    t.irradiance_size = 256;
    t.irradiance_quantity = Quantity::irradiance_over_pi;
    t.brdf_form = BrdfForm::scale_bias_charlie;
    return t;
}

}  // namespace domelight
