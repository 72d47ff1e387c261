#include "engines/all.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// Unity reads level = 6 r (1.7 - 0.7 r) of seven: 0.7 r^2 - 1.7 r + level / 6 = 0, the root below 1.
double unity_roughness(double level, int levels, int) {
    const double y = levels > 1 ? level / (levels - 1) : 0;
    return (1.7 - std::sqrt(std::max(0.0, 2.89 - 2.8 * y))) / 1.4;
}

}  // namespace

/// Unity: a DDS cube of half floats with the seven levels that its shaders read, and the environment as a lat-long EXR
/// for the importer (Texture Shape: Cube). Unity's world is left-handed with +Y up; its glTF importers turn (x, y, z)
/// into (-x, y, z), so the cube is mirrored in x. Its lat-long pictures have +Z in the centre and +X on the right,
/// which is -X in glTF's world.
Engine unity_engine() {
    Engine e;
    e.name = "unity";
    e.loads = "Unity: DDS cube with its seven levels, and a lat-long EXR for its own importer";
    e.note = "by its documents and published shaders, not run here";
    e.size = 256;
    e.smallest = 4;  // 256^2 to 4^2: seven
    e.roughness = unity_roughness;
    e.level_text = "M r (1.7 - 0.7 r)";
    e.mirror = CubeMirror::x;
    e.container = Container::dds;
    e.specular_file = "{stem}";
    e.panorama_file = "{stem}_latlong";
    e.panorama = "latlong/usd";
    e.irradiance_file = "";  // it lights with harmonics: sh.json
    e.brdf_file = "";
    e.brdf_form = BrdfForm::none;
    return e;
}

}  // namespace domelight
