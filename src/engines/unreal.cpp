#include "engines/all.h"

#include <cmath>

namespace domelight {
namespace {

/// Unreal reads level = last - (1 - 1.2 log2 r): r = 2^((level - last + 1) / 1.2), 1 from the last but one on. Level 0
/// is the environment itself.
double unreal_roughness(int level, int levels, int) {
    const int last = levels - 1;
    if (level == 0) return 0;
    return level >= last - 1 ? 1 : std::exp2((level - last + 1) / 1.2);
}

}  // namespace

/// Unreal Engine: the environment as a lat-long EXR, which its importer turns into a cube for a sky light (and
/// filters), and a DDS cube with the levels that its reflection captures use. Unreal's world is left-handed with +Z up:
/// glTF's (x, y, z) is (x, z, y) there, and that is how the cube is looked up. Its importer reads a lat-long picture at
/// u = 1/2 + atan2(X, -Y) / 2 pi, so glTF's -Z is in the centre and to the right of it lies +X.
Target unreal_target() {
    Target t;
    t.name = "unreal";
    t.consumer = "Unreal Engine: lat-long EXR for its own importer, and a DDS cube with its levels";
    t.note = "by its documents and what is published of its importer, not run here";
    t.size = 256;
    t.smallest = 1;
    t.roughness = unreal_roughness;
    t.mirror = CubeMirror::swap_yz;
    t.container = Container::dds;
    t.specular_file = "{stem}";
    t.panorama_file = "{stem}_latlong";
    t.panorama = "latlong/materialx";
    t.irradiance_file = "";
    t.brdf_file = "";
    t.brdf_form = BrdfForm::none;
    return t;
}

}  // namespace domelight
