#include "engines/all.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// Babylon reads level = 0.8 log2(N alpha): alpha = min(1, 2^(level / 0.8) / N), and the mirror at level 0.
double babylon_roughness(double level, int, int size) {
    if (level <= 0) return 0;
    return std::sqrt(std::min(1.0, std::exp2(level / 0.8) / size));
}

}  // namespace

/// Babylon.js: its own .env, RGBD pictures with every level down to 1^2 and a polynomial for diffuse light. Its world
/// is left-handed by default: a glTF direction (x, y, z) is (-x, y, z) there, so the cube is mirrored in x.
Engine babylon_engine() {
    Engine e;
    e.name = "babylon";
    e.loads = "Babylon.js: .env, a cube of RGBD pictures and diffuse light as a polynomial (CubeTexture)";
    e.note = "RGBD ends at 255: the manifest says what was clipped; the format dds keeps half floats";
    e.size = 256;
    e.smallest = 1;
    e.roughness = babylon_roughness;
    e.level_text = "0.8 log2(N r^2), N the faces' size";
    e.mirror = CubeMirror::x;
    e.encoding = Encoding::rgbd;
    e.container = Container::env;
    e.specular_file = "{stem}";
    e.irradiance_file = "";
    e.brdf_file = "";
    e.brdf_form = BrdfForm::none;
    return e;
}

}  // namespace domelight
