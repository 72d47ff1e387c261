#include "engines/chain.h"

#include <algorithm>

namespace domelight {

LevelPlan glossy_level(Lobe lobe, int size, double roughness) {
    LevelPlan level;
    level.spec = glossy_level_spec(lobe, size, roughness);
    level.roughness = lobe == Lobe::charlie ? std::max(roughness, k_charlie_least_roughness) : roughness;
    level.alpha = level.roughness * level.roughness;
    return level;
}

LevelPlan phong_level(Lobe lobe, int size, double exponent) {
    LevelPlan level;
    level.spec = phong_level_spec(lobe, size, exponent);
    level.exponent = exponent;
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
