#include "cli/render/render_job.h"

#include "domelight/probe/scene_hash.h"

#include "cli/console/print.h"
#include "cli/render/render_outputs.h"
#include "preview/exposure_meter.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight::cli {

Result<std::optional<LightMaps>> maps_for(const RenderWords& w, const EnvironmentSampler& sampler) {
    const bool shades = !w.reference() && w.probes.empty();
    if (!shades && w.backdrop != Background::blurred) return std::optional<LightMaps>{};
    const Lobe lobe = w.shading == ShadingModel::phong ? shading_lobe(ShadingModel::phong) : Lobe::ggx;
    auto maps = w.maps.empty() ? LightMaps::bake(sampler.image(), sampler.world_to_source(), w.threads(), lobe)
                               : LightMaps::load(w.maps);
    if (!maps) return maps.error();
    return std::optional<LightMaps>(std::move(*maps));
}

Result<std::optional<ProbeSet>> probes_for(const RenderWords& w, const Scene& scene) {
    if (w.probes.empty()) return std::optional<ProbeSet>{};
    auto set = ProbeSet::load(w.probes);
    if (!set) return set.error();
    if (!set->scene().sha256.empty() && set->scene().sha256 != scene_sha256(scene))
        print_warnings({fmt::format("the probes were captured in another scene, or in {} before it was changed: their "
                                    "light may not be that of this one",
                                    set->scene().file)},
                       w.common, w.probes);
    return std::optional<ProbeSet>(std::move(*set));
}

BlendOptions blend_options(const RenderWords& w) {
    BlendOptions o;
    o.most = w.probe_blend.value_or(o.most);
    o.visibility = w.probe_visibility;
    o.parallax = w.parallax;
    o.normal_offset = float(w.probe_offset);
    return o;
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
                                      const EngineLight& light, const RenderOptions& options, double ev) {
    auto traced = draw(w, scene, sampler, light, tracing_options(w, options));
    if (!traced) return traced.error();
    return finish(w, scene, sampler, options, std::move(*traced), ev);
}

}  // namespace domelight::cli
