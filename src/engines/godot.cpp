#include "engines/all.h"
#include "engines/environment_engine.h"

namespace domelight {

/// Godot 4's PanoramaSkyMaterial: a lat-long image that its sky shader reads at u = atan2(x, -z) / 2 pi modulo 1, so
/// the centre is +Z and to the right of it lies -X, in a world that is glTF's own (right-handed, +Y up). It filters
/// the sky for reflections by itself, into octahedral maps since 4.6.
Engine godot_engine() {
    Engine e = environment_engine("godot", "Godot 4: lat-long EXR for PanoramaSkyMaterial", "latlong/usd");
    e.note = "Godot filters this image itself; by its documents and source, not run here";
    return e;
}

}  // namespace domelight
