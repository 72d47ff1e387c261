#pragma once

#include "domelight/bake/bake.h"

#include "bake/panorama.h"
#include "engines/chain.h"
#include "texture/texel_order.h"

#include <functional>
#include <vector>

namespace domelight {

/// An engine with the options applied: the one statement of what is filtered, and of how it is stored.
struct EnginePlan {
    const Engine* engine = nullptr;
    Layout layout = Layout::cube;
    Lobe lobe = Lobe::ggx;
    Texels texels = Texels::centre;  ///< of specular and sheen
    std::vector<LevelPlan> specular;
    std::vector<LevelPlan> sheen;
    /// The level that the engine's shader reads for a roughness; empty if the roughness of each level was asked for.
    std::function<double(double roughness)> level_of;
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
    /// Of the files of the chain and the irradiance: name and convention, as projections.h takes them.
    std::string projection = "cube";
    TexelOrder order;          ///< from the maps to that projection
    bool reprojected = false;  ///< the maps are reprojected instead, because texels do not only change their places
};

/// Plans the bake for each of BakeOptions::engines. Errors: options that contradict each other or an engine; `where` is
/// the option.
///
/// environment   null before it is opened: an image that is to be as large as the source then has some other size
Result<std::vector<EnginePlan>> plan_bake(const BakeOptions& options, const Environment* environment);

}  // namespace domelight
