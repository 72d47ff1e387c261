#include "engines/all.h"
#include "engines/environment_engine.h"

namespace domelight {

/// Mitsuba 3's `envmap`: u = atan2(x, -z) / 2 pi modulo 1 (centre +Z, right -X) in a world of glTF's axes, with row j
/// of H at theta = pi j / (H - 1): the first and the last row are the poles.
Engine mitsuba_engine() {
    return environment_engine("mitsuba", "Mitsuba 3: lat-long EXR with rows on the poles (envmap emitter)",
                              "latlong/mitsuba");
}

}  // namespace domelight
