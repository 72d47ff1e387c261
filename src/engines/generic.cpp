#include "engines/all.h"

namespace domelight {

/// For an engine of one's own: cube 512^2 down to 8^2 in seven levels, roughness = level / (levels - 1), half floats,
/// the true irradiance E.
Target generic_target() {
    Target t;
    t.name = "generic";
    t.consumer = "an engine of your own: KTX2 cubes, RGBA16F, roughness = level / (levels - 1), irradiance E";
    t.roughness = linear_roughness;
    return t;
}

}  // namespace domelight
