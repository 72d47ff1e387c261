#pragma once
// The levels of a chain: stated here once, for the bake and for everything else that filters what an engine loads.

#include "domelight/engines/engine.h"
#include "domelight/filtering/prefilter.h"

#include <vector>

namespace domelight {

/// One level of a chain, with its kernel and the values that are recorded of it.
struct LevelPlan {
    LevelSpec spec;
    double roughness = 0, alpha = 0, exponent = 0;
};

/// A level of GGX or Charlie. At roughness 0 it is the environment itself; Charlie's roughness is raised to
/// k_charlie_least_roughness.
LevelPlan glossy_level(Lobe lobe, int size, double roughness);

/// A level of a Phong lobe; infinity is the environment itself.
LevelPlan phong_level(Lobe lobe, int size, double exponent);

/// The engine's own chain of cubes from its size down, filtered with GGX or a Phong lobe.
std::vector<LevelPlan> default_chain(const Engine& engine, Lobe lobe);

}  // namespace domelight
