#include "engines/all.h"

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

/// Babylon.js: its own .env, RGBD pictures with every level down to 1^2 and a polynomial for diffuse light. Its world
/// is left-handed by default: a glTF direction (x, y, z) is (-x, y, z) there, so the cube is mirrored in x.
Target babylon_target() {
    Target t;
    t.name = "babylon";
    t.consumer = "Babylon.js: .env, a cube of RGBD pictures and diffuse light as a polynomial (CubeTexture)";
    t.note = "RGBD ends at 255: the manifest says what was clipped; --format dds keeps half floats";
    t.size = 256;
    t.smallest = 1;
    t.roughness = babylon_roughness;
    t.mirror = CubeMirror::x;
    t.encoding = Encoding::rgbd;
    t.container = Container::env;
    t.specular_file = "{stem}";
    t.irradiance_file = "";
    t.brdf_file = "";
    t.brdf_form = BrdfForm::none;
    return t;
}

}  // namespace domelight
