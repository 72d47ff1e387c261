#include "cli/render/render_job.h"

#include "cli/render/render_outputs.h"
#include "preview/exposure_meter.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight::cli {

Result<std::optional<LightMaps>> maps_for(const RenderWords& w, const EnvironmentSampler& sampler) {
    if (w.reference() && w.backdrop != Background::blurred) return std::optional<LightMaps>{};
    const Lobe lobe = w.shading == ShadingModel::phong ? shading_lobe(ShadingModel::phong) : Lobe::ggx;
    auto maps = w.maps.empty() ? LightMaps::bake(sampler.image(), sampler.world_to_source(), w.threads(), lobe)
                               : LightMaps::load(w.maps);
    if (!maps) return maps.error();
    return std::optional<LightMaps>(std::move(*maps));
}

PunctualLight turned_light(PunctualLight light, const Mat3& turn) {
    light.direction = Vec3f(turn * Vec3d(light.direction));
    light.position = Vec3f(turn * Vec3d(light.position));
    return light;
}

std::vector<std::string> non_finite_warning(std::int64_t samples) {
    if (samples == 0) return {};
    return {fmt::format("{} sample{} infinite or not a number, and count as black", samples,
                        samples == 1 ? " was" : "s were")};
}

RenderOptions tracing_options(const RenderWords& w, RenderOptions o) {
    // A background colour is a colour on the display: it is put behind the picture after the tone map.
    if (w.shadow_catcher || o.background == Background::colour) o.background = Background::transparent;
    return o;
}

Result<FinishedPicture> finish(const RenderWords& w, const RayScene& scene, const EnvironmentSampler& sampler,
                               const RenderOptions& options, RenderResult traced, double ev) {
    FinishedPicture out{std::move(traced), ev};
    const RenderOptions tracing = tracing_options(w, options);
    if (std::isnan(ev)) {
        ExposureMeter meter;
        meter.add(out.result.radiance, out.result.opacity, tracing.background == Background::transparent);
        out.ev = meter.ev();
    }
    if (!w.shadow_catcher) return out;
    RenderOptions o = options;
    if (o.background == Background::colour) o.background = Background::transparent;
    ShadowCatcher catcher;
    catcher.height = scene.scene().bounds().low.y;
    catcher.samples = std::clamp(out.result.sample_count, o.samples, std::max(o.samples, 1024));
    if (auto ok = catch_shadow(out.result, scene, sampler, catcher, o); !ok) return ok.error();
    return out;
}

Result<FinishedPicture> draw_finished(const RenderWords& w, const RayScene& scene, const EnvironmentSampler& sampler,
                                      const LightMaps* maps, const RenderOptions& options, double ev) {
    auto traced = draw(w, scene, sampler, maps, tracing_options(w, options));
    if (!traced) return traced.error();
    return finish(w, scene, sampler, options, std::move(*traced), ev);
}

}  // namespace domelight::cli
