#pragma once
// The truth: a scene under an environment by path tracing.
//
//     auto scene = load_scene("helmet.glb");
//     auto traced = RayScene::build(std::move(*scene));
//     auto sampler = EnvironmentSampler::build(*environment, reference_sampler_options());
//     auto picture = render_reference(*traced, *sampler, options);

#include "domelight/sampling/environment_sampler.h"
#include "domelight/base/progress.h"
#include "domelight/scene/scene.h"

#include <functional>
#include <map>
#include <memory>

namespace domelight {

/// A scene with its acceleration structure.
class RayScene {
  public:
    /// Built on all cores. Errors: no triangles; out of memory.
    static Result<RayScene> build(Scene scene);
    ~RayScene();
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;

    const Scene& scene() const;
    /// Bytes of the acceleration structure.
    std::size_t memory_bytes() const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

  private:
    RayScene();
    std::unique_ptr<Impl> impl_;
};

/// Where light directions come from.
enum class LightStrategy {
    mis,          ///< both, weighted by the balance heuristic
    environment,  ///< in proportion to radiance
    brdf,         ///< by the surface
};

class LightMaps;

/// What shows where no surface is. It does not light the scene.
enum class Background {
    environment,
    blurred,      ///< the environment prefiltered for a roughness: RenderOptions::background_maps
    colour,       ///< RenderOptions::background_colour
    transparent,  ///< nothing: radiance is black there, opacity 0
};

/// How far a render is.
struct RenderStatus {
    double samples = 0;  ///< of a pixel, mean
    double noise = 0;    ///< standard error of L / (1 + L), rms over the pixels that have two samples or more
    double seconds = 0;  ///< since the start
};

struct RenderResult;

struct RenderOptions {
    int width = 512, height = 512;
    Camera camera;
    LightStrategy strategy = LightStrategy::mis;
    int samples = 64;  ///< of each pixel
    double noise =
        0;  ///< > 0: samples go on (to `most_samples`) where a pixel's standard error, of L / (1 + L), is above this
    int most_samples = 65536;
    double seconds = 0;  ///< > 0: stop after so long; the result then depends on the machine
    int bounces = 0;     ///< of indirect light; 0: direct light with shadows
    /// How many surfaces a path may go through (KHR_materials_transmission), reflections inside a body counted, before
    /// they count as bounces: what is seen through glass is direct light. Glass casts a full shadow: what it lets
    /// through onto other surfaces is indirect light, and needs a bounce.
    int refractions = 16;
    bool occlusion =
        true;  ///< false: no shadows, and no indirect light: what a shader without them must be compared with. Glass
               ///< then shows the environment in the direction refracted at its first surface, through its `thickness`
    bool multiple_scattering = false;  ///< GGX's lost energy given back (Turquin 2019); glTF's own model does not
    Background background = Background::environment;
    Vec3f background_colour;                     ///< linear radiance
    float background_roughness = 0.35f;          ///< blurred: of the level that shows
    const LightMaps* background_maps = nullptr;  ///< blurred: must be set, and outlive the call
    /// Lights that were taken out of the environment (load_environment_lights): they light the scene beside its own.
    std::vector<PunctualLight> environment_lights;
    std::uint64_t seed = 0;
    int threads = 0;
    Progress progress;
    /// Reference: told before each call of `progress`, and as seldom.
    std::function<void(const RenderStatus&)> status;
    /// Reference: where it is set, the picture as it stands (complete, with fewer samples) is handed over between
    /// rounds whenever `checkpoint_wanted` says so, and once when `progress` has cancelled the rest. The final result
    /// is the same.
    std::function<void(const RenderResult&)> checkpoint;
    std::function<bool()> checkpoint_wanted;  ///< empty: always
};

/// Layers, each width x height; RGB radiance unless said otherwise. Means over the pixel's samples.
struct RenderResult {
    ImageF radiance;
    ImageF opacity;            ///< 1 channel: the part of the pixel that surfaces cover
    ImageF direct, indirect;   ///< of `radiance`, without the background
    ImageF diffuse, specular;  ///< the same light by the first surface's lobe (emission is in neither)
    ImageF albedo, normal;     ///< of the first surface, in the world
    ImageF depth;              ///< 1 channel: distance from the eye, mean of what was hit; infinite where nothing was
    ImageF object;             ///< 1 channel: instance + 1 of the pixel's first sample, 0: none
    /// Of the mean, of each channel of `radiance`, as if samples were independent: Sobol points make it an upper guess.
    ImageF variance;
    ImageF samples;      ///< 1 channel
    double noise = 0;    ///< standard error of L / (1 + L), mean over the picture (rms)
    double seconds = 0;  ///< by the clock
    std::int64_t rays = 0;
    int sample_count = 0;  ///< the most of any pixel
    /// Samples whose radiance is infinite or not a number. They count as black: their pixels are too dark.
    std::int64_t non_finite_samples = 0;
};

/// The sampler's options that suit the strategy: a bilinear density, with MIS compensation where the BRDF covers what
/// it leaves out.
EnvironmentSamplerOptions reference_sampler_options(LightStrategy strategy = LightStrategy::mis, int threads = 0);

/// Same bits on any number of threads (unless stopped by the clock). Errors: "cancelled".
Result<RenderResult> render_reference(const RayScene& scene, const EnvironmentSampler& sampler,
                                      const RenderOptions& options);

/// Light that falls on an invisible ground under the scene, with it and without it: what a picture of the scene put
/// into a photograph darkens it by.
struct ShadowCatcher {
    float height = 0;  ///< of the ground, +Y
    int samples = 64;  ///< of each pixel
};
/// Puts the scene's shadow and the background into a picture that was rendered with Background::transparent and the
/// same options. Where a camera ray passes the scene and meets the ground, the background is multiplied by E with the
/// scene over E without it, E the irradiance of the environment and the scene's lights on the ground, each channel on
/// its own, both from the same light directions, so that ground without shadow stays as it was to the last bit. Ground
/// gives no light back to the scene. With a transparent background opacity becomes 1 - (1 - opacity) (E with / E
/// without), of luminance, and radiance stays: a black shadow. Errors: "cancelled".
Result<void> catch_shadow(RenderResult& picture, const RayScene& scene, const EnvironmentSampler& sampler,
                          const ShadowCatcher& catcher, const RenderOptions& options);

/// What of a scene's materials render_reference does not know: "clearcoat of 2 materials is left out", for a warning.
std::vector<std::string> not_rendered(const Scene& scene);

/// A camera that looks from `eye` at `target`, +Y up.
Camera look_at(const Vec3f& eye, const Vec3f& target, float fov_y);
/// The camera for a picture of another shape, width / height, than it was made for: what it was made to show stays in the
/// picture, which shows more at the sides, or above and below. A camera without a shape stays as it is.
Camera camera_for(Camera camera, float aspect);
/// The scene's own camera if it has one, else one that looks from the front, a little above, and frames the scene
/// however it is turned about the vertical axis through its middle.
Camera default_camera(const Scene& scene, float aspect);

}  // namespace domelight
