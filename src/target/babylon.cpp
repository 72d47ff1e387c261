#include "target/all.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// Babylon reads level = 0.8 log2(N alpha): alpha = min(1, 2^(level / 0.8) / N), and the mirror at level 0.
double babylon_roughness(int level, int, int size) {
    if (level == 0) return 0;
    return std::sqrt(std::min(1.0, std::exp2(level / 0.8) / size));
}

}  // namespace

/// Babylon.js: a prefiltered DDS cube, RGBA16F, with every level down to 1^2, from which it computes its own polynomial
/// for diffuse light. Its world is left-handed by default: a glTF direction (x, y, z) is (-x, y, z) there, so the cube
/// is mirrored in x. That reading is from its source; the picture has not been compared in a browser yet. Its own
/// container, .env, is not written yet.
Target babylon_target() {
    Target t;
    t.name = "babylon";
    t.consumer = "Babylon.js: prefiltered DDS cube, RGBA16F (CubeTexture.CreateFromPrefilteredData)";
    t.note =
        "its own container, .env, is not written yet; Babylon loads the DDS as it is and computes its diffuse "
        "polynomial itself";
    t.size = 256;
    t.smallest = 1;
    t.roughness = babylon_roughness;
    t.mirror = CubeMirror::x;
    t.container = Container::dds;
    t.specular_file = "{stem}";
    t.irradiance_file = "";
    t.brdf_file = "";
    t.brdf_form = BrdfForm::none;
    return t;
}

}  // namespace domelight
