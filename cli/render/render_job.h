#pragma once

#include "domelight/render/render.h"
#include "domelight/render/shading/shading.h"

#include "cli/render/render_options.h"

#include <optional>

namespace domelight::cli {

/// The maps that the words ask for: read from --maps, baked, or none where nothing would read them.
Result<std::optional<LightMaps>> maps_for(const RenderWords& words, const EnvironmentSampler& sampler);

/// One picture without its shadow catcher, by the shading that was asked for. `maps` may be null where maps_for() gives
/// none.
Result<RenderResult> draw(const RenderWords& words, const RayScene& scene, const EnvironmentSampler& sampler,
                          const LightMaps* maps, const RenderOptions& options);

/// A light of the environment after the environment has been turned about the origin.
PunctualLight turned_light(PunctualLight light, const Mat3& turn);

/// A warning where samples were lost because their radiance was not finite, and else nothing.
std::vector<std::string> non_finite_warning(std::int64_t samples);

/// A picture as it is written: with the shadow, and the stops for a display.
struct FinishedPicture {
    RenderResult result;
    double ev = 0;
};
/// Draws with `options` (whose background is the one that will show). `ev`: NaN for what the picture asks for.
Result<FinishedPicture> draw_finished(const RenderWords& words, const RayScene& scene,
                                      const EnvironmentSampler& sampler, const LightMaps* maps,
                                      const RenderOptions& options, double ev);
/// The options with which the tracing itself runs: what is put behind the scene afterwards is left out.
RenderOptions tracing_options(const RenderWords& words, RenderOptions options);
/// Adds the shadow where it was asked for.
Result<FinishedPicture> finish(const RenderWords& words, const RayScene& scene, const EnvironmentSampler& sampler,
                               const RenderOptions& options, RenderResult traced, double ev);

}  // namespace domelight::cli
