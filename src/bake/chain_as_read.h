#pragma once
// A chain of a bake as its engine's shader reads it.

#include "domelight/compare/read_error.h"

#include "bake/plan.h"

#include <span>

namespace domelight {

/// The chain in the plan's encoding, decoded again, with the curve by which the engine finds the level. A chain in
/// Radiance HDR is left as it is: RGBE is not an encoding of textures.
///
/// levels, maps   of the specular chain or of the sheen's, with as many elements
ReadChain chain_as_read(const EnginePlan& plan, Lobe lobe, std::span<const LevelPlan> levels,
                        std::span<const FilteredMap> maps, const BakeOptions& options);

}  // namespace domelight
