#pragma once

#include "domelight/bake/bake.h"

#include "bake/panorama.h"

#include <vector>

namespace domelight {

/// One level of a chain, with its kernel and the values that are recorded of it.
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
    std::vector<LevelSpec> gap_probes;  ///< of a Phong chain: phong_gaps.h
    Encoding encoding = Encoding::rgba16f;
    Container container = Container::ktx2;
    bool zstd = false;
    int irradiance_size = 0;  ///< of the map that is computed: cube face, or height
    Quantity irradiance_quantity = Quantity::irradiance;
    int brdf_size = 0;
    BrdfForm brdf_form = BrdfForm::none;
    std::optional<PanoramaSpec> panorama;  ///< the environment as one image, where the engine takes it
    bool size_of_source = false;           ///< the only map is a panorama, as large as the environment
    int latlong_quarters = 0;  ///< the quarter turns of the engine's lat-long maps: turn_latlong() of bake/mirror.h
};

/// Plans the bake for an engine. Errors: options that contradict each other or the engine; `where` is the option.
///
/// environment   null before it is opened: an image that is to be as large as the source then has some other size
Result<EnginePlan> plan_engine(const Engine& engine, const BakeOptions& options, const Environment* environment);

}  // namespace domelight
