#include "target/all.h"

namespace domelight {

/// three.js: the environment as a lat-long half-float EXR in its own orientation (which is Domelight's default), for
/// its PMREM generator to filter. That generator makes cubes of a quarter of the width: 2048 x 1024 fills its 512^2.
/// The prefiltered UASTC HDR cube that newer versions load is not written yet.
Target three_target() {
    Target t;
    t.name = "three";
    t.consumer = "three.js: lat-long EXR for its own filter (EXRLoader, PMREMGenerator)";
    t.note = "three.js filters this image itself; the prefiltered .pmrem.ktx2 is not written yet";
    t.roughness = linear_roughness;
    t.container = Container::exr;
    t.environment_only = true;
    t.specular_file = "{stem}";
    t.irradiance_file = "";
    t.brdf_file = "";
    t.brdf_form = BrdfForm::none;
    return t;
}

}  // namespace domelight
