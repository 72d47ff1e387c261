#include "engines/all.h"
#include "engines/environment_engine.h"

namespace domelight {

/// USD's DomeLight with texture:format = latlong: centre +Z, right -X, +Y up, in a world of glTF's axes.
Target usd_target() {
    Target t =
        environment_target("usd", "USD (Hydra, Omniverse, Houdini): lat-long EXR for a DomeLight", "latlong/usd");
    t.note = "by its documents, not run here";
    return t;
}

}  // namespace domelight
