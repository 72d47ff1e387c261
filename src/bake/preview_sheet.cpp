#include "bake/preview_sheet.h"

#include "domelight/preview/preview.h"

#include <fmt/core.h>

#include <cmath>

namespace domelight {
namespace {

std::string level_detail(const EnginePlan& plan, const LevelPlan& level) {
    if (plan.lobe == Lobe::ggx || plan.lobe == Lobe::charlie) return {};
    return std::isinf(level.exponent) ? "the environment" : fmt::format("exponent {:.4g}", level.exponent);
}

}  // namespace

Image<std::uint8_t> draw_preview(const EnginePlan& plan, const FilterJob::Maps& maps, const EngineReport& report,
                                 const std::string& title, const ImageF& brdf, int threads) {
    PreviewInput input;
    input.title = title;
    input.subtitle = fmt::format("{} · {} · {}", lobe_name(plan.lobe), report.maps.front().encoding, plan.engine->name);
    FilteredMap panorama;  // stands for the first level where there are none
    if (plan.engine->environment_only) {
        panorama.latlong = panorama_as_latlong(maps.panorama, plan.panorama->projection, 512, threads);
        input.specular.push_back({&panorama, 0, 0, {}});
    }
    for (std::size_t l = 0; l < maps.specular.size(); ++l) {
        const LevelPlan& level = plan.specular[l];
        input.specular.push_back({&maps.specular[l], level.roughness, level.alpha, level_detail(plan, level)});
    }
    input.irradiance_over_pi = &maps.irradiance_over_pi;
    input.sh = report.sh.radiance;
    if (plan.brdf_form != BrdfForm::none) input.brdf = brdf;
    input.threads = threads;
    return contact_sheet(input);
}

}  // namespace domelight
