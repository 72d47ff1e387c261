#pragma once
// How well a shader reads an exponent that lies between two levels of a Phong chain.

#include "domelight/bake/bake.h"

#include "bake/plan.h"

#include <span>
#include <vector>

namespace domelight {

/// Small maps for measuring the gaps of a chain: the exponent of each level but the environment itself, and between two
/// of them the one half way between them. Exponents fall. Empty where the chain has no gap.
std::vector<LevelSpec> phong_gap_probes(std::span<const LevelPlan> chain);

/// The error of each gap, from the maps that phong_gap_probes() asked for.
std::vector<PhongGap> phong_gaps(std::span<const LevelSpec> probes, std::span<const FilteredMap> maps);

}  // namespace domelight
