#pragma once

#include "domelight/bake/bake.h"

#include <vector>

namespace domelight {

/// One level of a chain with its kernel and what is recorded of it.
struct LevelPlan {
    LevelSpec spec;
    double roughness = 0, alpha = 0, exponent = 0;
};

/// An engine with the options applied.
struct EnginePlan {
    const Engine* engine = nullptr;
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
    /// Of the environment as one image (0: none): `panorama_size` is the height of that image, `panorama_rows` of the
    /// lat-long image in the default convention that it is made from.
    int panorama_size = 0, panorama_rows = 0;
    int latlong_quarters = 0;  ///< how far the engine's lat-long maps are turned: turn_latlong() of bake/mirror.h
};

/// What to make for an engine. Errors: options that contradict each other or the engine; `where` is the option.
Result<EnginePlan> plan_engine(const Engine& engine, const BakeOptions& options);

}  // namespace domelight
