#include "bake/preview_sheet.h"

#include "domelight/preview/preview.h"

#include "bake/panorama.h"
#include "preview/preview_map.h"

#include <fmt/core.h>

#include <cmath>

namespace domelight {
namespace {

std::string level_detail(const EnginePlan& plan, const LevelPlan& level) {
    if (plan.lobe == Lobe::ggx || plan.lobe == Lobe::charlie) return {};
    return std::isinf(level.exponent) ? "the environment" : fmt::format("exponent {:.4g}", level.exponent);
}

/// What the channels of an engine's BRDF table hold.
std::string brdf_detail(BrdfForm form) {
    switch (form) {
        case BrdfForm::none:
            return {};
        case BrdfForm::scale_bias:
            return "red scale, green bias";
        case BrdfForm::multiscatter:
            return "red bias, green scale + bias";
        case BrdfForm::scale_bias_charlie:
            return "RGB: scale, bias, sheen";
    }
    return {};
}

std::string irradiance_detail(const EnginePlan& plan, const FilteredMap& over_pi) {
    if (plan.container == Container::playcanvas_atlas) return "in the atlas";
    if (plan.engine->environment_only || plan.engine->irradiance_file.empty()) return "for comparison; not a file";
    return size_text(over_pi) +
           (plan.irradiance_quantity == Quantity::irradiance ? ", stored as E" : ", stored as E / π");
}

std::string subtitle(const EnginePlan& plan, const EngineReport& report) {
    const std::string stored = fmt::format("{} · {}", report.maps.front().encoding, plan.engine->name);
    return plan.engine->environment_only ? stored : name_of(plan.lobe) + " · " + stored;
}

}  // namespace

Image<std::uint8_t> draw_preview(const EnginePlan& plan, const FilterJob::Maps& maps, const EngineReport& report,
                                 const std::string& title, const ImageF& brdf, int threads) {
    PreviewInput input;
    input.title = title;
    input.subtitle = subtitle(plan, report);
    FilteredMap panorama;  // shown as the first level where there are no levels
    if (plan.engine->environment_only) {
        const PanoramaSpec& spec = *plan.panorama;
        panorama = {Layout::latlong, panorama_as_latlong(maps.panorama->image, spec.projection, 512, threads)};
        input.specular.push_back({.map = &panorama,
                                  .detail = "projection " + spec.projection,
                                  .name = fmt::format("the environment · {} × {}", spec.width, spec.height)});
    }
    for (std::size_t l = 0; l < maps.specular.size(); ++l) {
        const LevelPlan& level = plan.specular[l];
        input.specular.push_back({.map = &maps.specular[l],
                                  .roughness = level.roughness,
                                  .alpha = level.alpha,
                                  .detail = level_detail(plan, level)});
    }
    for (std::size_t l = 0; l < maps.sheen.size(); ++l)
        input.sheen.push_back(
            {.map = &maps.sheen[l], .roughness = plan.sheen[l].roughness, .alpha = plan.sheen[l].alpha});
    input.irradiance_over_pi = maps.irradiance_over_pi;
    input.irradiance_detail = irradiance_detail(plan, *maps.irradiance_over_pi);
    input.sh = report.sh.radiance;
    if (plan.brdf_form != BrdfForm::none) input.brdf = brdf;
    input.brdf_channels = plan.brdf_form == BrdfForm::scale_bias_charlie ? 3 : 2;
    input.brdf_detail = brdf_detail(plan.brdf_form);
    input.threads = threads;
    return contact_sheet(input);
}

}  // namespace domelight
