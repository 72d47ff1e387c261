#pragma once
// The reference picture: a scene under an environment, by path tracing.
//
//     auto scene = load_scene("helmet.glb");
//     auto traced = RayScene::build(std::move(*scene));
//     auto sampler = EnvironmentSampler::build(*environment, reference_sampler_options());
//     auto picture = render_reference(*traced, *sampler, options);

#include "domelight/base/names.h"
#include "domelight/base/progress.h"
#include "domelight/sampling/environment_sampler.h"
#include "domelight/scene/scene.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>

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
    mis,          ///< by both of the following, weighted by the balance heuristic
    environment,  ///< in proportion to radiance
    brdf,         ///< in proportion to the surface's BRDF
};
template <>
struct EnumNames<LightStrategy> {
    static constexpr const char* kind = "a strategy";
    static constexpr NamedValue<LightStrategy> table[] = {
        {LightStrategy::mis, "mis"},
        {LightStrategy::environment, "env"},
        {LightStrategy::brdf, "brdf"},
    };
};

class LightMaps;

/// What is seen where there is no surface. The choice does not change the lighting.
enum class Background {
    environment,
    blurred,      ///< the environment, prefiltered for a roughness: RenderOptions::background_maps
    colour,       ///< RenderOptions::background_colour
    transparent,  ///< nothing: the radiance is black there, and the opacity 0
};
template <>
struct EnumNames<Background> {
    static constexpr const char* kind = "a background";
    static constexpr NamedValue<Background> table[] = {
        {Background::environment, "environment"}, {Background::blurred, "blurred"},
        {Background::colour, "colour"},           {Background::colour, "color"},
        {Background::transparent, "transparent"},
    };
};

/// The progress of a render.
struct RenderStatus {
    double samples = 0;  ///< of a pixel, on average
    double noise = 0;    ///< standard error of L / (1 + L), rms over the pixels with two samples or more
    double seconds = 0;  ///< since the start
};

struct RenderResult;

struct RenderOptions {
    int width = 512, height = 512;
    Camera camera;
    LightStrategy strategy = LightStrategy::mis;
    int samples = 64;  ///< of each pixel
    /// > 0: a pixel gets more samples (up to `most_samples`) while the standard error of its L / (1 + L) is above this
    double noise = 0;
    int most_samples = 65536;
    double seconds = 0;  ///< > 0: stop after this time; the result then depends on the machine
    int bounces = 0;     ///< of indirect light; 0: direct light with shadows
    /// How many surfaces a path may pass through (KHR_materials_transmission; reflections inside a body count too)
    /// before they count as bounces. What is seen through glass is direct light. Glass casts a full shadow: the light
    /// that passes through it onto other surfaces is indirect light and needs a bounce.
    int refractions = 16;
    bool occlusion =
        true;  ///< false: no shadows and no indirect light, for comparison with a shader that has neither. Glass then
               ///< shows the environment in the direction refracted at its first surface, through its `thickness`
    bool multiple_scattering = false;  ///< compensates the energy that GGX loses (Turquin 2019); not part of glTF's own
                                       ///< model
    Background background = Background::environment;
    Vec3f background_colour;                     ///< linear radiance
    float background_roughness = 0.35f;          ///< blurred: the roughness of the prefiltered level that is shown
    const LightMaps* background_maps = nullptr;  ///< blurred: must be set, and outlive the call
    /// Lights that were taken out of the environment (load_environment_lights): they light the scene beside its own.
    std::vector<PunctualLight> environment_lights;
    std::uint64_t seed = 0;
    int threads = 0;
    Progress progress;
    /// Reference only: called just before each call of `progress`.
    std::function<void(const RenderStatus&)> status;
    /// Reference only: if set, called between rounds with the picture so far (complete, with fewer samples) whenever
    /// `checkpoint_wanted` returns true, and once more when `progress` has cancelled the render. The final result does
    /// not depend on it.
    std::function<void(const RenderResult&)> checkpoint;
    std::function<bool()> checkpoint_wanted;  ///< empty: always
};

/// Layers, each width x height; RGB radiance unless stated otherwise. Values are means over the pixel's samples.
struct RenderResult {
    ImageF radiance;
    ImageF opacity;            ///< 1 channel: the part of the pixel that is covered by surfaces
    ImageF direct, indirect;   ///< of `radiance`, without the background
    ImageF diffuse, specular;  ///< the same light, split by the lobe of the first surface (emission is in neither)
    ImageF albedo, normal;     ///< of the first surface, in the world
    ImageF depth;              ///< 1 channel: mean distance from the eye to the surfaces hit; infinite if there are
                               ///< none
    ImageF object;             ///< 1 channel: instance + 1 of the pixel's first sample, 0: none
    /// The variance of the mean of each channel of `radiance`, computed as if samples were independent. With Sobol
    /// points it is an overestimate.
    ImageF variance;
    ImageF samples;      ///< 1 channel
    double noise = 0;    ///< standard error of L / (1 + L), rms over all pixels; a pixel with one sample counts as 0
    double seconds = 0;  ///< wall-clock time
    std::int64_t rays = 0;
    int sample_count = 0;  ///< the most of any pixel
    /// Samples whose radiance is infinite or not a number. They count as black: their pixels are too dark.
    std::int64_t non_finite_samples = 0;
};

/// The sampler options that suit the strategy: a bilinear density; with MIS compensation for LightStrategy::mis, where
/// BRDF sampling covers the directions that compensation leaves out.
EnvironmentSamplerOptions reference_sampler_options(LightStrategy strategy = LightStrategy::mis, int threads = 0);

/// The bits are the same on any number of threads (unless the time limit stops the render). Errors: "cancelled".
Result<RenderResult> render_reference(const RayScene& scene, const EnvironmentSampler& sampler,
                                      const RenderOptions& options);

/// An invisible ground under the scene that receives its shadow, so that the picture can be placed into a photograph.
struct ShadowCatcher {
    float height = 0;  ///< of the ground, along +Y
    int samples = 64;  ///< of each pixel
};
/// Puts the scene's shadow and the background into a picture that was rendered with Background::transparent and the
/// same options. Where a camera ray misses the scene and meets the ground, each channel of the background is multiplied
/// by E_with / E_without: the irradiance on the ground from the environment and the scene's lights, with and without
/// the shadows of the scene. Both are estimated from the same light directions, so ground without shadow is unchanged
/// to the last bit. The ground reflects no light onto the scene.
///
/// With a transparent background the opacity becomes 1 - (1 - opacity) Y(E_with) / Y(E_without), where Y is the
/// luminance, and the radiance is unchanged: a black shadow. Light that is infinite or not a number is left out, and
/// its samples are added to RenderResult::non_finite_samples. Errors: "cancelled".
Result<void> catch_shadow(RenderResult& picture, const RayScene& scene, const EnvironmentSampler& sampler,
                          const ShadowCatcher& catcher, const RenderOptions& options);

/// What a picture shows of a scene.
struct SceneView {
    std::optional<int> width, height;  ///< pixels, 1 .. 16384; without both, the width is 512
    const Camera* camera = nullptr;    ///< one of the scene's; not used where `eye` is set
    std::optional<Vec3f> eye;          ///< a camera there looks at `target`
    Vec3f target{};
    float fov_y = 0.6f;  ///< of that camera, radians
};
/// Sets the camera and the size of the picture. A width or height that is not given follows from the camera's own aspect
/// ratio, which is 1 where it has none. Without a camera and an eye it is default_camera().
void set_view(RenderOptions& options, const Scene& scene, const SceneView& view);

/// Features of the scene's materials that render_reference does not support, as warnings: "clearcoat of 2 materials is
/// left out".
std::vector<std::string> not_rendered(const Scene& scene);

/// A camera that looks from `eye` at `target`, +Y up. `fov_y`: the vertical field of view in radians.
Camera look_at(const Vec3f& eye, const Vec3f& target, float fov_y);
/// Adapts a camera to a picture of aspect ratio `aspect` = width / height, > 0. Everything that the camera shows at its
/// own aspect ratio stays visible; a wider picture shows more at the sides, a narrower one more above and below. A
/// camera whose `aspect` is 0 is returned unchanged.
Camera camera_for(Camera camera, float aspect);
/// The scene's own camera if it has one, else one that looks from the front, a little above, and frames the scene
/// however it is turned about the vertical axis through its middle.
Camera default_camera(const Scene& scene, float aspect);

}  // namespace domelight
