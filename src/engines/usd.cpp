#include "engines/all.h"
#include "engines/environment_engine.h"

namespace domelight {

/// USD's DomeLight with texture:format = latlong: centre +Z, right -X, +Y up, in a world of glTF's axes.
Engine usd_engine() {
    Engine e =
        environment_engine("usd", "USD (Hydra, Omniverse, Houdini): lat-long EXR for a DomeLight", "latlong/usd");
    e.note = "by its documents, not run here";
    return e;
}

}  // namespace domelight
