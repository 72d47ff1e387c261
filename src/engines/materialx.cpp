#include "engines/all.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// MaterialX reads level = last * (alpha < 1/4 ? sqrt(alpha) : alpha / 2 + 3/8). With y = level / last: alpha = y^2
/// below y = 1/2, else min(1, 2 y - 3/4).
double materialx_roughness(double level, int levels, int) {
    const double y = levels > 1 ? level / (levels - 1) : 0;
    return y < 0.5 ? y : std::sqrt(std::min(1.0, 2 * y - 0.75));
}

}  // namespace

/// MaterialX' generated shaders with prefiltered light (`$envRadiance`, `$envIrradiance`): a lat-long OpenEXR with its
/// levels, and a lat-long image of E / pi. Centre -Z, right +X.
Engine materialx_engine() {
    Engine e;
    e.name = "materialx";
    e.loads = "MaterialX shader generation: lat-long EXR with levels, and lat-long E / pi";
    e.note = "by its documents and published shaders, not run here";
    e.size = 256;
    e.smallest = 8;
    e.roughness = materialx_roughness;
    e.level_text = "M (r < 1/2 ? r : r^2 / 2 + 3/8)";
    e.layout = Layout::latlong;
    e.latlong = "materialx";
    e.container = Container::exr_mip;
    e.specular_file = "{stem}";
    e.irradiance_file = "{stem}_irradiance";
    e.irradiance_size = 64;
    e.irradiance_quantity = Quantity::irradiance_over_pi;
    e.brdf_file = "";
    e.brdf_form = BrdfForm::none;
    return e;
}

}  // namespace domelight
