#include "engines/all.h"
#include "engines/environment_engine.h"

namespace domelight {

/// Blender's Environment Texture node: a lat-long image with Blender's +X in the centre and -Y on the right. Blender's
/// world has +Z up; its (x, y, z) is glTF's (x, -z, y), so that is our default: centre +X, right +Z.
Engine blender_engine() {
    return environment_engine("blender", "Blender (Cycles, EEVEE): lat-long EXR for the world's Environment Texture",
                              "latlong");
}

}  // namespace domelight
