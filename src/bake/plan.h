#pragma once

#include "domelight/bake.h"

#include <vector>

namespace domelight {

/// One level of a chain with its kernel and what is recorded of it.
struct LevelPlan {
    LevelSpec spec;
    double roughness = 0, alpha = 0, exponent = 0;
};

/// A target with the options applied.
struct TargetPlan {
    const Target* target = nullptr;
    Layout layout = Layout::cube;
    Lobe lobe = Lobe::ggx;
    std::vector<LevelPlan> specular;
    std::vector<LevelPlan> sheen;
    Encoding encoding = Encoding::rgba16f;
    Container container = Container::ktx2;
    bool zstd = false;
    int irradiance_size = 0;  ///< of the map that is computed: cube face, or height
    int brdf_size = 0;
    BrdfForm brdf_form = BrdfForm::none;
};

/// What to make for a target. Errors: options that contradict each other or the target; `where` is the option.
Result<TargetPlan> plan_target(const Target& target, const BakeOptions& options);

}  // namespace domelight
