#include "engines/all.h"
#include "engines/environment_engine.h"

namespace domelight {

/// pbrt-v4's `infinite` light: a square in the equal-area octahedral mapping (Clarberg 2008), its middle up. pbrt's
/// light space has +Z up; its (x, y, z) is glTF's (x, -z, y).
Target pbrt_target() {
    Target t = environment_target("pbrt", "pbrt-v4: equal-area octahedral EXR (infinite light)", "pbrt");
    t.note = "by its documents, not run here";
    return t;
}

}  // namespace domelight
