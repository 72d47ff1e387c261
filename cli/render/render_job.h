#pragma once

#include "domelight/probe/probe_blend.h"
#include "domelight/render/render.h"
#include "domelight/render/shading/shading.h"

#include "cli/render/render_options.h"

#include <optional>

namespace domelight::cli {

/// The maps that the command line asks for: read from --maps, or baked; none if the shading does not use any.
Result<std::optional<LightMaps>> maps_for(const RenderWords& words, const EnvironmentSampler& sampler);
/// The probes of --probes; none without it. Warns if they were captured in another scene.
Result<std::optional<ProbeSet>> probes_for(const RenderWords& words, const Scene& scene);
/// The options of the blend.
BlendOptions blend_options(const RenderWords& words);

/// What an engine's shader reads.
struct EngineLight {
    const LightMaps* maps = nullptr;       ///< null if maps_for() gives none
    const ProbeBlender* probes = nullptr;  ///< null without --probes
};

/// One picture without its shadow catcher, by the shading that was asked for.
Result<RenderResult> draw(const RenderWords& words, const RayScene& scene, const EnvironmentSampler& sampler,
                          const EngineLight& light, const RenderOptions& options);

/// A warning if samples were lost because their radiance was not finite; otherwise nothing.
std::vector<std::string> non_finite_warning(std::int64_t samples);

/// A picture as it is written: with the shadow, and the stops for a display.
struct FinishedPicture {
    RenderResult result;
    double ev = 0;
};
/// Draws with `options`, whose background is the one that is shown. `ev`: NaN for an exposure that suits the picture.
Result<FinishedPicture> draw_finished(const RenderWords& words, const RayScene& scene,
                                      const EnvironmentSampler& sampler, const EngineLight& light,
                                      const RenderOptions& options, double ev);
/// The options for the tracing itself, without the background that is put behind the scene afterwards.
RenderOptions tracing_options(const RenderWords& words, RenderOptions options);
/// Adds the shadow if it was asked for.
Result<FinishedPicture> finish(const RenderWords& words, const RayScene& scene, const EnvironmentSampler& sampler,
                               const RenderOptions& options, RenderResult traced, double ev);

}  // namespace domelight::cli
