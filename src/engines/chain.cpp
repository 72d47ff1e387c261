#include "engines/chain.h"

#include <algorithm>
#include <cmath>

namespace domelight {

LevelPlan glossy_level(Lobe lobe, int size, double roughness) {
    // Charlie has no mirror: its lobe lies along the horizon.
    if (lobe == Lobe::charlie) roughness = std::max(roughness, k_charlie_least_roughness);
    LevelPlan level;
    level.roughness = roughness;
    level.alpha = roughness * roughness;
    level.spec.size = size;
    level.spec.mirror = roughness == 0;
    level.spec.kernel = {lobe, level.alpha};
    if (level.spec.mirror) level.spec.kernel.width = 1;  // not used; any valid kernel
    return level;
}

LevelPlan phong_level(Lobe lobe, int size, double exponent) {
    LevelPlan level;
    level.exponent = exponent;
    level.spec.size = size;
    level.spec.mirror = std::isinf(exponent);
    level.spec.kernel = {lobe, level.spec.mirror ? 1.0 : exponent};
    return level;
}

std::vector<LevelPlan> default_chain(const Engine& engine, Lobe lobe) {
    const int count = default_levels(engine, engine.size, lobe);
    const auto exponents = default_phong_exponents(count);
    std::vector<LevelPlan> levels;
    for (int l = 0; l < count; ++l)
        levels.push_back(is_phong(lobe)
                             ? phong_level(lobe, engine.size >> l, exponents[std::size_t(l)])
                             : glossy_level(lobe, engine.size >> l, engine.roughness(l, count, engine.size)));
    return levels;
}

}  // namespace domelight
