#include "engines/all.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// From level 1 on each level's roughness is the same part of the next one's, and the last has 1; below level 1 a
/// straight line. That part is 0.6, or more in a long chain, so that level 1 has 0.08 at least. At 0.6 a lobe is 2.8
/// times as wide from level to level, and the error of mixing two of them much the same everywhere
/// (docs/math/prefilter.md, "Between texels and between levels").
double geometric_roughness(double level, int levels, int) {
    constexpr double k_least = 0.08;
    const double last = levels - 1, ratio = last > 1 ? std::max(0.6, std::pow(k_least, 1 / (last - 1))) : 1;
    return level < 1 ? std::pow(ratio, last - 1) * level : std::pow(ratio, last - level);
}

}  // namespace

/// For your own engine: cube 512^2 down to 16^2 in six levels, of roughness 0, 0.13, 0.216, 0.36, 0.6 and 1, half
/// floats, the true irradiance E.
Engine generic_engine() {
    Engine e;
    e.name = "generic";
    e.loads = "an engine of your own: KTX2 cubes, RGBA16F, roughness in a geometric series, irradiance E";
    e.smallest = 16;
    e.smallest_phong = 8;
    e.fewest_levels = 3;
    e.roughness = geometric_roughness;
    e.level_text = "r <= r1 ? r / r1 : M - (M - 1) log(r) / log(r1), r1 = max(0.6^(M - 1), 0.08)";
    return e;
}

}  // namespace domelight
