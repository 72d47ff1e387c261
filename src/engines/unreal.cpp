#include "engines/all.h"

#include <cmath>

namespace domelight {
namespace {

/// Unreal reads level = last - (1 - 1.2 log2 r): r = 2^((level - last + 1) / 1.2), 1 from the last but one on. Level 0
/// is the environment itself.
double unreal_roughness(double level, int levels, int) {
    const int last = levels - 1;
    if (level <= 0) return 0;
    return level >= last - 1 ? 1 : std::exp2((level - last + 1) / 1.2);
}

}  // namespace

/// Unreal Engine: the environment as a lat-long EXR, which its importer turns into a cube for a sky light (and
/// filters), and a DDS cube with the levels that its reflection captures use. Unreal's world is left-handed with +Z up:
/// glTF's (x, y, z) is (x, z, y) there, and that is how the cube is looked up. Its importer reads a lat-long picture at
/// u = 1/2 + atan2(X, -Y) / 2 pi, so glTF's -Z is in the centre and to the right of it lies +X.
Engine unreal_engine() {
    Engine e;
    e.name = "unreal";
    e.loads = "Unreal Engine: lat-long EXR for its own importer, and a DDS cube with its levels";
    e.note = "by its documents and what is published of its importer, not run here";
    e.size = 256;
    e.smallest = 1;
    e.roughness = unreal_roughness;
    e.level_text = "M - 1 + 1.2 log2(r)";
    e.mirror = CubeMirror::swap_yz;
    e.container = Container::dds;
    e.specular_file = "{stem}";
    e.panorama_file = "{stem}_latlong";
    e.panorama = "latlong/materialx";
    e.irradiance_file = "";
    e.brdf_file = "";
    e.brdf_form = BrdfForm::none;
    return e;
}

}  // namespace domelight
