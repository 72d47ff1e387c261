#include "engines/all.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// MaterialX reads level = last * (alpha < 1/4 ? sqrt(alpha) : alpha / 2 + 3/8). With y = level / last: alpha = y^2
/// below y = 1/2, else min(1, 2 y - 3/4).
double materialx_roughness(int level, int levels, int) {
    const double y = levels > 1 ? double(level) / (levels - 1) : 0;
    return y < 0.5 ? y : std::sqrt(std::min(1.0, 2 * y - 0.75));
}

}  // namespace

/// MaterialX' generated shaders with prefiltered light (`$envRadiance`, `$envIrradiance`): a lat-long OpenEXR with its
/// levels, and a lat-long image of E / pi. Centre -Z, right +X.
Target materialx_target() {
    Target t;
    t.name = "materialx";
    t.consumer = "MaterialX shader generation: lat-long EXR with levels, and lat-long E / pi";
    t.note = "by its documents and published shaders, not run here";
    t.size = 256;
    t.smallest = 8;
    t.roughness = materialx_roughness;
    t.layout = Layout::latlong;
    t.latlong = "materialx";
    t.container = Container::exr_mip;
    t.specular_file = "{stem}";
    t.irradiance_file = "{stem}_irradiance";
    t.irradiance_size = 64;
    t.irradiance_quantity = Quantity::irradiance_over_pi;
    t.brdf_file = "";
    t.brdf_form = BrdfForm::none;
    return t;
}

}  // namespace domelight
