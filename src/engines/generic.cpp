#include "engines/all.h"

namespace domelight {

/// For your own engine: cube 512^2 down to 8^2 in seven levels, roughness = level / (levels - 1), half floats,
/// the true irradiance E.
Engine generic_engine() {
    Engine e;
    e.name = "generic";
    e.loads = "an engine of your own: KTX2 cubes, RGBA16F, roughness = level / (levels - 1), irradiance E";
    e.roughness = linear_roughness;
    return e;
}

}  // namespace domelight
