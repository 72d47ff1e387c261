#include "engines/all.h"

#include <cmath>

namespace domelight {
namespace {

/// From level 1 on each level has 0.6 times the roughness of the next, and the last has 1; below level 1 a straight
/// line. A lobe is then 2.8 times as wide from level to level, and the error of mixing two of them much the same
/// everywhere (docs/math/prefilter.md, "Between texels and between levels").
double geometric_roughness(double level, int levels, int) {
    constexpr double k_ratio = 0.6;
    const double last = levels - 1, first = std::pow(k_ratio, last - 1);
    return level < 1 ? first * level : std::pow(k_ratio, last - level);
}

}  // namespace

/// For your own engine: cube 512^2 down to 16^2 in six levels, roughness = 0.6^(last - level) and 0 in level 0, half
/// floats, the true irradiance E.
Engine generic_engine() {
    Engine e;
    e.name = "generic";
    e.loads = "an engine of your own: KTX2 cubes, RGBA16F, roughness = 0.6^(last - level), irradiance E";
    e.smallest = 16;
    e.smallest_phong = 8;
    e.fewest_levels = 3;
    e.roughness = geometric_roughness;
    e.level_text = "r < 0.6^(M - 1) ? r / 0.6^(M - 1) : M - log(r) / log(0.6)";
    return e;
}

}  // namespace domelight
