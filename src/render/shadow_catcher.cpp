// The ground of a photograph under a scene: only the shadow that the scene casts on it is drawn.

#include "domelight/base/parallel.h"
#include "domelight/image/colour.h"
#include "domelight/sampling/sequences.h"
#include "domelight/sampling/warps.h"

#include "render/background.h"
#include "render/camera.h"
#include "render/punctual.h"
#include "render/surface/surface.h"

#include <atomic>
#include <cmath>
#include <mutex>

namespace domelight {
namespace {

constexpr int k_most_passages = 64;
constexpr int k_pixel_pair = 0, k_light_pair = 1, k_cosine_pair = 2;

/// The sums over one pixel's samples.
struct GroundSums {
    Vec3d with, without;     ///< irradiance on the ground
    Vec3d ground, beyond;    ///< background behind the ground, and where the ray misses it
    double ground_part = 0;  ///< over the samples, without the share of transparent surfaces
    int non_finite = 0;      ///< samples of which some light was infinite or not a number, and was left out
};

bool is_finite(const Vec3d& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

class ShadowTracer {
  public:
    ShadowTracer(const RayScene& scene, const EnvironmentSampler& sampler, const ShadowCatcher& catcher,
                 const RenderOptions& options)
        : rays_(scene.impl()),
          scene_(scene.scene()),
          sampler_(sampler),
          options_(options),
          lights_(all_lights(scene_, options)),
          height_(catcher.height),
          camera_(options.camera, options.width, options.height),
          passages_(has_passages(scene_)) {}

    /// The same camera samples as in render_reference and render_shaded, so that edges match.
    void sample(int x, int y, std::uint32_t index, GroundSums& sums) const {
        const std::uint64_t key =
            derive_key(options_.seed, std::uint64_t(y) * std::uint64_t(options_.width) + std::uint64_t(x));
        const auto point = [&](int pair) { return sobol_owen(derive_key(key, std::uint64_t(pair)), index); };
        const Ray ray = camera_.through(x, y, point(k_pixel_pair));
        const float rest = transmittance(ray);
        if (rest <= 0) return;
        const Vec3d seen = Vec3d(background_radiance(options_, sampler_, ray.direction)) * double(rest);
        const bool finite = is_finite(seen);
        const Vec3d behind = finite ? seen : Vec3d();
        const float distance = (height_ - ray.origin.y) / ray.direction.y;
        // Seen from below, there is no ground.
        if (!(distance > 0) || !(ray.direction.y < 0) || !std::isfinite(distance)) {
            sums.beyond += behind;
            sums.non_finite += !finite;
            return;
        }
        sums.ground += behind;
        sums.ground_part += rest;
        const Vec3f p = ray.origin + ray.direction * distance;
        const bool lit = light_ground({p.x, height_, p.z}, point(k_light_pair), point(k_cosine_pair), rest, sums);
        sums.non_finite += !finite || !lit;
    }

  private:
    /// E with and without the scene at a point of the ground: one sample of each strategy, combined by the balance
    /// heuristic. Returns whether all light was finite; what is not is left out.
    bool light_ground(const Vec3f& p, UnitPoint light_point, UnitPoint cosine_point, float weight,
                      GroundSums& sums) const {
        bool finite = true;
        const auto add = [&](const Vec3f& direction, const Vec3f& light, float distance) {
            const Vec3d all = Vec3d(light) * double(weight);
            if (!is_finite(all)) {
                finite = false;
                return;
            }
            if (!(luminance(all) > 0)) return;
            sums.without += all;
            sums.with += all * double(visibility(p, direction, distance));
        };
        constexpr float far = std::numeric_limits<float>::infinity();
        const LightSample light = sampler_.sample(light_point);
        if (light.direction.y > 0) {
            const float cosine = light.direction.y, pdf = light.pdf_solid_angle + cosine / float(k_pi);
            add(light.direction, light.radiance * (cosine / pdf), far);
        }
        const Vec3f up = cosine_hemisphere(cosine_point), direction{up.x, up.z, up.y};
        if (direction.y > 0) {
            const LightSample there = sampler_.look_up(direction);
            const float pdf = there.pdf_solid_angle + direction.y / float(k_pi);
            add(direction, there.radiance * (direction.y / pdf), far);
        }
        for (const PunctualLight& l : lights_) {
            const PunctualArrival a = arrival_at(l, p);
            if (a.strength > 0 && a.direction.y > 0)
                add(a.direction, l.intensity * (a.strength * a.direction.y), a.distance);
        }
        return finite;
    }

    float visibility(const Vec3f& p, const Vec3f& direction, float distance) const {
        const Ray ray{p, direction, 0};
        if (!passages_ && std::isinf(distance)) return rays_.occluded(ray) ? 0 : 1;
        return transmittance(ray, distance);
    }

    float transmittance(Ray ray, float distance = std::numeric_limits<float>::infinity()) const {
        float rest = 1;
        for (int passage = 0; passage < k_most_passages && rest > 0; ++passage) {
            const Hit hit = rays_.intersect(ray, false);
            if (hit.instance < 0 || hit.distance >= distance) break;
            if (!passages_) return 0;
            rest *= 1 - opacity_at(scene_, hit);
            pass(ray, hit);
        }
        return rest;
    }

    const RayScene::Impl& rays_;
    const Scene& scene_;
    const EnvironmentSampler& sampler_;
    const RenderOptions& options_;
    const std::vector<PunctualLight> lights_;
    float height_;
    CameraRays camera_;
    bool passages_;
};

double ratio(double with, double without) {
    return without > 0 ? with / without : 1;
}

}  // namespace

Result<void> catch_shadow(RenderResult& picture, const RayScene& scene, const EnvironmentSampler& sampler,
                          const ShadowCatcher& catcher, const RenderOptions& o) {
    if (auto fine = check_background(o); !fine) return fine;
    const ShadowTracer tracer(scene, sampler, catcher, o);
    const int width = picture.radiance.width(), height = picture.radiance.height(),
              samples = std::max(1, catcher.samples);
    std::atomic<bool> cancelled{false};
    std::atomic<int> done{0};
    std::atomic<std::int64_t> non_finite{0};
    std::mutex progress_mutex;
    parallel_for(height, o.threads, [&](int y) {
        if (cancelled) return;
        for (int x = 0; x < width; ++x) {
            float& opacity = *picture.opacity.at(x, y);
            if (opacity >= 1) continue;
            GroundSums s;
            for (int i = 0; i < samples; ++i) tracer.sample(x, y, std::uint32_t(i), s);
            non_finite += s.non_finite;
            const Vec3d left{ratio(s.with.x, s.without.x), ratio(s.with.y, s.without.y), ratio(s.with.z, s.without.z)};
            if (o.background == Background::transparent) {
                opacity += float(s.ground_part / samples * (1 - ratio(luminance(s.with), luminance(s.without))));
            } else {
                const Vec3f behind((product(s.ground, left) + s.beyond) / double(samples));
                float* p = picture.radiance.at(x, y);
                p[0] += behind.x, p[1] += behind.y, p[2] += behind.z;
            }
        }
        ++done;
        if (o.progress) {
            const std::lock_guard lock(progress_mutex);
            if (!o.progress("shadow", double(done) / height)) cancelled = true;
        }
    });
    if (cancelled) return Error{"cancelled", "", ""};
    picture.non_finite_samples += non_finite;
    return {};
}

}  // namespace domelight
