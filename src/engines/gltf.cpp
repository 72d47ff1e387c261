#include "engines/all.h"

namespace domelight {

/// A glTF file with EXT_lights_image_based: RGBD pictures of a cube from 256^2 to 16^2 whose levels map evenly to
/// roughness 0 to 1, in OpenGL's orientation; nine coefficients of the irradiance E.
Engine gltf_engine() {
    Engine e;
    e.name = "gltf";
    e.loads = "glTF with EXT_lights_image_based: RGBD pictures and nine coefficients of E";
    e.note = "RGBD ends at 255: the manifest says what was clipped";
    e.size = 256;
    e.smallest = 16;
    e.roughness = linear_roughness;
    e.level_text = "M r";
    e.encoding = Encoding::rgbd;
    e.container = Container::gltf;
    e.specular_file = "{stem}";
    e.irradiance_file = "";
    e.brdf_file = "";
    e.brdf_form = BrdfForm::none;
    return e;
}

}  // namespace domelight
