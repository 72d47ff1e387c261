#include "engines/all.h"

namespace domelight {

/// A glTF file with EXT_lights_image_based: RGBD pictures of a cube from 256^2 to 16^2 whose levels map evenly to
/// roughness 0 to 1, in OpenGL's orientation; nine coefficients of the irradiance E.
Target gltf_target() {
    Target t;
    t.name = "gltf";
    t.consumer = "glTF with EXT_lights_image_based: RGBD pictures and nine coefficients of E";
    t.note = "RGBD ends at 255: the manifest says what was clipped";
    t.size = 256;
    t.smallest = 16;
    t.roughness = linear_roughness;
    t.encoding = Encoding::rgbd;
    t.container = Container::gltf;
    t.specular_file = "{stem}";
    t.irradiance_file = "";
    t.brdf_file = "";
    t.brdf_form = BrdfForm::none;
    return t;
}

}  // namespace domelight
