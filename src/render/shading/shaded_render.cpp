// A scene with the shading of a real-time engine: only the first surface of each camera sample is shaded, and no
// further rays are traced.

#include "domelight/base/parallel.h"
#include "domelight/sampling/sequences.h"

#include "base/field_place.h"
#include "render/background.h"
#include "render/camera.h"
#include "render/film.h"
#include "render/punctual.h"
#include "render/shading/probe_light.h"
#include "render/shading/shading_models.h"

#include <fmt/core.h>

#include <atomic>
#include <chrono>
#include <mutex>

namespace domelight {
namespace {

class ShadedTracer {
  public:
    /// Either the maps or the probes are null.
    ShadedTracer(const RayScene& scene, const LightMaps* maps, const ProbeBlender* probes,
                 const EnvironmentSampler& environment, const ShadingOptions& shading, const RenderOptions& options)
        : rays_(scene.impl()),
          scene_(scene.scene()),
          maps_(maps),
          probes_(probes),
          environment_(environment),
          reflected_(environment, shading.lookup, shading.lookup_size, options.threads),
          shading_(shading),
          options_(options),
          lights_(all_lights(scene_, options)),
          camera_(options.camera, options.width, options.height) {}

    void sample(int x, int y, std::uint32_t index, PixelSums& sums) const {
        const std::uint64_t key =
            derive_key(options_.seed, std::uint64_t(y) * std::uint64_t(options_.width) + std::uint64_t(x));
        Ray ray = camera_.through(x, y, sobol_owen(derive_key(key, 0), index));
        Vec3f light, diffuse, specular;
        float rest = 1;  // the transmittance of the surfaces so far
        FirstSurface first;
        constexpr int most_layers = 16;
        for (int layer = 0; layer < most_layers && rest > 0; ++layer) {
            const Hit hit = rays_.intersect(ray, true);
            if (hit.instance < 0) {
                light += background_radiance(options_, environment_, ray.direction) * rest;
                break;
            }
            const SurfacePoint s = surface_at(scene_, hit, ray.origin, ray.direction, false);
            if (s.opacity > 0) {
                const ShadedLight shaded = s.unlit ? ShadedLight{} : shade(s, hit, -ray.direction);
                const float part = rest * s.opacity;
                diffuse += shaded.diffuse * part;
                specular += shaded.specular * part;
                light += (shaded.diffuse + shaded.specular + s.emission) * part;
                if (!first.covered) first = {true, s.albedo, s.normal, hit.distance, float(hit.instance + 1)};
                rest -= part;
            }
            pass(ray, hit);
        }
        const Vec3d r(light);
        if (!sums.accepts(r)) return;
        if (first.covered) add_surface(first, sums);
        sums.radiance += r;
        sums.squares += Vec3d{r.x * r.x, r.y * r.y, r.z * r.z};
        sums.diffuse += diffuse;
        sums.specular += specular;
        sums.direct = sums.direct + diffuse + specular;
        ++sums.count;
    }

  private:
    /// What the layers of geometry hold of a sample.
    struct FirstSurface {
        bool covered = false;
        Vec3f albedo, normal;
        float depth = 0, object = 0;
    };

    static void add_surface(const FirstSurface& first, PixelSums& sums) {
        sums.albedo += first.albedo;
        sums.normal += first.normal;
        sums.depth += first.depth;
        sums.covered += 1;
        if (sums.count == 0) sums.object = first.object;
    }

    ShadedLight shade(const SurfacePoint& s, const Hit& hit, const Vec3f& V) const {
        const float ior = scene_.materials[scene_.meshes[scene_.instances[hit.instance].mesh].material].ior;
        const ShadedLight around = probes_ ? shade_by(ProbeLight(*probes_, s), s, hit, V, ior)
                                           : shade_by(*maps_, s, hit, V, ior),
                          lights = shade_by_lights(s, V, ior);
        return {around.diffuse + lights.diffuse, around.specular + lights.specular};
    }

    ShadedLight shade_by(const LightAt& light, const SurfacePoint& s, const Hit& hit, const Vec3f& V, float ior) const {
        const float occlusion = shading_.occlusion ? occlusion_at(scene_, hit) : 1;
        switch (shading_.model) {
            case ShadingModel::split_sum:
                return shade_split_sum(s, V, occlusion, light, shading_);
            case ShadingModel::stretched:
                return shade_stretched(s, V, occlusion, light, shading_);
            case ShadingModel::phong:
                return shade_phong(s, V, occlusion, light, shading_);
            case ShadingModel::mirror:
                return shade_mirror(s, V, reflected_);
            case ShadingModel::refract:
                break;
        }
        return shade_refract(s, V, ior, reflected_);
    }

    /// With probes the lights cast shadows: in a room, most of what they would light is behind walls.
    ShadedLight shade_by_lights(const SurfacePoint& s, const Vec3f& V, float ior) const {
        if (!probes_ || !options_.occlusion) return shade_lights(shading_.model, s, V, ior, lights_);
        ShadedLight sum;
        for (const PunctualLight& light : lights_) {
            const PunctualArrival arrival = arrival_at(light, s.position);
            if (arrival.strength <= 0 || is_shadowed(s, arrival)) continue;
            const ShadedLight one = shade_lights(shading_.model, s, V, ior, {&light, 1});
            sum.diffuse += one.diffuse, sum.specular += one.specular;
        }
        return sum;
    }

    bool is_shadowed(const SurfacePoint& s, const PunctualArrival& arrival) const {
        const Hit hit = rays_.intersect(s.ray_to(arrival.direction), false);
        return hit.instance >= 0 && hit.distance < arrival.distance;
    }

    const RayScene::Impl& rays_;
    const Scene& scene_;
    const LightMaps* maps_;
    const ProbeBlender* probes_;
    const EnvironmentSampler& environment_;
    const EnvironmentMap reflected_;  ///< the map that mirror and refract read
    const ShadingOptions& shading_;
    const RenderOptions& options_;
    const std::vector<PunctualLight> lights_;
    CameraRays camera_;
};

}  // namespace

Lobe shading_lobe(ShadingModel model) {
    return model == ShadingModel::phong ? Lobe::phong_brdf : Lobe::ggx;
}

namespace {

Result<void> check_options(const ShadingOptions& shading, const RenderOptions& o) {
    if (auto fine = check_size(o.width, o.height); !fine) return fine;
    if (auto fine = check_background(o); !fine) return fine;
    if (shading.lookup_size < 1 || shading.lookup_size > 8192)
        return Error{fmt::format("a map of {} texels is not from 1 to 8192", shading.lookup_size), "", ""};
    return {};
}

Result<RenderResult> trace(const ShadedTracer& tracer, const RenderOptions& o) {
    const auto start = std::chrono::steady_clock::now();
    Film film(o.width, o.height);
    std::atomic<bool> cancelled{false};
    std::atomic<int> done{0};
    std::mutex progress_mutex;
    parallel_for(film.tiles(), o.threads, [&](int t) {
        if (cancelled) return;
        for (int i = 0; i < int(film.tile(t).size()); ++i)
            for (int k = 0; k < std::max(1, o.samples); ++k)
                tracer.sample(film.x0(t) + i % film.columns(t), film.y0(t) + i / film.columns(t), std::uint32_t(k),
                              film.tile(t)[i]);
        ++done;
        if (o.progress) {
            const std::lock_guard lock(progress_mutex);
            if (!o.progress("shade", double(done) / film.tiles())) cancelled = true;
        }
    });
    if (cancelled) return Error{"cancelled", "", ""};
    RenderResult out = develop(film, o.width, o.height);
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return out;
}

}  // namespace

Result<RenderResult> render_shaded(const RayScene& scene, const LightMaps& maps, const EnvironmentSampler& environment,
                                   const ShadingOptions& shading, const RenderOptions& o) {
    if (auto fine = check_options(shading, o); !fine) return fine.error();
    const bool wants_phong = shading_lobe(shading.model) == Lobe::phong_brdf,
               reads_chain = shading.model < ShadingModel::mirror;
    if (reads_chain && wants_phong != (maps.lobe() != Lobe::ggx))
        return Error{
            fmt::format("has a chain of lobe {}, which {} does not read", name_of(maps.lobe()), name_of(shading.model)),
            "", fmt::format("Bake with `lobe` {}.", name_of(shading_lobe(shading.model)))};
    return trace(ShadedTracer(scene, &maps, nullptr, environment, shading, o), o);
}

Result<RenderResult> render_shaded(const RayScene& scene, const ProbeBlender& probes,
                                   const EnvironmentSampler& environment, const ShadingOptions& shading,
                                   const RenderOptions& o) {
    if (auto fine = check_options(shading, o); !fine) return fine.error();
    if (shading.model >= ShadingModel::mirror)
        return Error{fmt::format("{} reads the environment, not probes", name_of(shading.model)), field_place("model"),
                     "With probes: split-sum, stretched or phong."};
    return trace(ShadedTracer(scene, nullptr, &probes, environment, shading, o), o);
}

}  // namespace domelight
