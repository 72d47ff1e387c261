#include "engines/all.h"
#include "engines/environment_engine.h"

namespace domelight {

/// pbrt-v4's `infinite` light: a square in the equal-area octahedral mapping (Clarberg 2008), its middle up. pbrt's
/// light space has +Z up; its (x, y, z) is glTF's (x, -z, y).
Engine pbrt_engine() {
    Engine e = environment_engine("pbrt", "pbrt-v4: equal-area octahedral EXR (infinite light)", "pbrt");
    e.note = "by its documents, not run here";
    return e;
}

}  // namespace domelight
