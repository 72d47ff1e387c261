#pragma once
// The truth: a scene under an environment by path tracing.
//
//     auto scene = load_scene("helmet.glb");
//     auto traced = RayScene::build(std::move(*scene));
//     auto sampler = EnvironmentSampler::build(*environment, reference_sampler_options());
//     auto picture = render_reference(*traced, *sampler, options);

#include "domelight/environment_sampler.h"
#include "domelight/progress.h"
#include "domelight/scene.h"

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

/// What shows where no surface is.
enum class Background { environment, transparent };

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
    bool occlusion =
        true;  ///< false: no shadows, and no indirect light: what a shader without them must be compared with
    bool multiple_scattering = false;  ///< GGX's lost energy given back (Turquin 2019); glTF's own model does not
    Background background = Background::environment;
    std::uint64_t seed = 0;
    int threads = 0;
    Progress progress;
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
};

/// The sampler's options that suit the strategy: a bilinear density, with MIS compensation where the BRDF covers what
/// it leaves out.
EnvironmentSamplerOptions reference_sampler_options(LightStrategy strategy = LightStrategy::mis, int threads = 0);

/// Same bits on any number of threads (unless stopped by the clock). Errors: "cancelled".
Result<RenderResult> render_reference(const RayScene& scene, const EnvironmentSampler& sampler,
                                      const RenderOptions& options);

/// What of a scene's materials the renderers do not know: "clearcoat of 2 materials are left out", for a warning.
std::vector<std::string> not_rendered(const Scene& scene);

/// A camera that looks from `eye` at `target`, +Y up.
Camera look_at(const Vec3f& eye, const Vec3f& target, float fov_y);
/// The scene's own camera if it has one, else one that frames it all from the front, a little above.
Camera default_camera(const Scene& scene, float aspect);

}  // namespace domelight
