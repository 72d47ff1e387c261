// Path tracing with next-event estimation: at each surface one light direction from the environment and one from the
// BRDF, weighted by the balance heuristic (Veach 1997, 9.2.2); the BRDF's ray goes on where light may bounce. Samples
// of a tile go through each step together, so that the environment is drawn from in batches.

#include "domelight/parallel.h"
#include "domelight/sequences.h"

#include "render/camera.h"
#include "render/film.h"
#include "render/surface.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>

namespace domelight {
namespace {

constexpr int k_batch = 1024;        ///< samples that go through the steps together
constexpr int k_most_passages = 64;  ///< transparent surfaces a ray passes at most
constexpr int k_roulette_from = 3;   ///< bounces before paths may end by chance

float largest(const Vec3f& c) {
    return std::max({c.x, c.y, c.z});
}

/// One sample of a pixel on its way.
struct Path {
    int pixel = 0;            ///< in the tile
    std::uint32_t index = 0;  ///< of the pixel's samples
    std::uint64_t key = 0;    ///< of the pixel
    Ray ray;
    Vec3f throughput{1, 1, 1};
    float pdf_brdf = 0;  ///< with which the ray was drawn; 0: by the camera
    Hit hit;
    SurfacePoint surface;
    Vec3f V;  ///< local
    /// Of what arrives along the path: the share of the first surface's diffuse lobe.
    Vec3f diffuse_share;

    Vec3f radiance, direct, indirect, diffuse, specular;
    Vec3f albedo, normal;
    float depth = 0;
    int object = 0;
    bool covered = false;

    UnitPoint point(int pair) const { return sobol_owen(derive_key(key, std::uint64_t(pair)), index); }
    /// Light that arrives after `bounce` bounces, parted among the layers.
    void add(const Vec3f& light, int bounce) {
        radiance = radiance + light;
        (bounce == 0 ? direct : indirect) = (bounce == 0 ? direct : indirect) + light;
        const Vec3f below = product(light, diffuse_share);
        diffuse = diffuse + below;
        specular = specular + (light - below);
    }
    /// The same at the first surface, where the lobes are known apart.
    void add(const Bsdf::Value& lobes, const Vec3f& light, int bounce) {
        if (bounce > 0) return add(product(lobes.sum(), light), bounce);
        const Vec3f d = product(lobes.diffuse, light), s = product(lobes.specular, light);
        radiance = radiance + d + s;
        direct = direct + d + s;
        diffuse = diffuse + d;
        specular = specular + s;
    }
};

/// The pairs of dimensions of a path.
constexpr int k_pixel_pair = 0, k_pairs_a_bounce = 3;
constexpr int light_pair(int bounce) {
    return 1 + k_pairs_a_bounce * bounce;
}
constexpr int brdf_pair(int bounce) {
    return 2 + k_pairs_a_bounce * bounce;
}
constexpr int chance_pair(int bounce) {
    return 3 + k_pairs_a_bounce * bounce;
}

/// Light samples of a batch.
struct LightBatch {
    LightBatch() : values(9 * k_batch), points(k_batch) {}
    LightSampleSpans spans(int n) {
        const auto part = [&](int k) { return std::span<float>(values.data() + k * k_batch, std::size_t(n)); };
        return {part(0), part(1), part(2), part(3), part(4), part(5), part(6), part(7), part(8)};
    }
    Vec3f direction(int i) const { return {values[2 * k_batch + i], values[3 * k_batch + i], values[4 * k_batch + i]}; }
    Vec3f radiance(int i) const { return {values[5 * k_batch + i], values[6 * k_batch + i], values[7 * k_batch + i]}; }
    float pdf(int i) const { return values[8 * k_batch + i]; }
    std::vector<float> values;
    std::vector<UnitPoint> points;
};

class Tracer {
  public:
    Tracer(const RayScene& scene, const EnvironmentSampler& sampler, const RenderOptions& options)
        : rays_(scene.impl()),
          scene_(scene.scene()),
          sampler_(sampler),
          options_(options),
          camera_(options.camera, options.width, options.height),
          passages_(has_passages(scene_)) {}

    /// Adds to the sums of a tile, `count[i]` samples to pixel i of it. Returns the rays traced.
    std::int64_t trace(int x0, int y0, int columns, std::span<const int> count, std::span<PixelSums> sums) const {
        std::vector<Path> paths;
        paths.reserve(k_batch);
        LightBatch light;
        std::int64_t rays = 0;
        const auto flush = [&] {
            rays += run(paths, light);
            for (const Path& p : paths) store(p, sums[p.pixel]);
            paths.clear();
        };
        for (int pixel = 0; pixel < int(count.size()); ++pixel) {
            const int x = x0 + pixel % columns, y = y0 + pixel / columns;
            const int first = sums[pixel].count;
            for (int i = 0; i < count[pixel]; ++i) {
                paths.emplace_back();
                start(paths.back(), pixel, x, y, std::uint32_t(first + i));
                if (int(paths.size()) == k_batch) flush();
            }
        }
        flush();
        return rays;
    }

  private:
    void start(Path& p, int pixel, int x, int y, std::uint32_t index) const {
        p.pixel = pixel;
        p.index = index;
        p.key = derive_key(options_.seed, std::uint64_t(y) * std::uint64_t(options_.width) + std::uint64_t(x));
        p.ray = camera_.through(x, y, p.point(k_pixel_pair));
    }

    /// The nearest surface that does not let the ray through.
    bool find(Path& p, int bounce, std::int64_t& rays) const {
        for (int passage = 0; passage < k_most_passages; ++passage) {
            p.hit = rays_.intersect(p.ray, bounce == 0);
            ++rays;
            if (p.hit.instance < 0) return false;
            if (!passages_) return true;
            const float opacity = opacity_at(scene_, p.hit);
            if (opacity >= 1) return true;
            // By chance, with numbers of their own for each surface passed.
            if (opacity > 0 && unit_float(sobol_owen(derive_key(derive_key(p.key, std::uint64_t(chance_pair(bounce))),
                                                                std::uint64_t(passage)),
                                                     p.index)
                                              .x) < opacity)
                return true;
            pass(p.ray, p.hit);
        }
        return false;
    }

    /// How much of the light from a direction arrives.
    float visibility(const SurfacePoint& s, const Vec3f& direction, std::int64_t& rays,
                     float distance = std::numeric_limits<float>::infinity()) const {
        if (!options_.occlusion) return 1;
        const float side = dot(direction, s.geometric_normal);
        if (side <= 0) return 0;
        Ray ray{s.position + s.geometric_normal * s.error, direction, 0};
        if (!passages_ && std::isinf(distance)) {
            ++rays;
            return rays_.occluded(ray) ? 0 : 1;
        }
        float through = 1;
        for (int passage = 0; passage < k_most_passages && through > 0; ++passage) {
            const Hit hit = rays_.intersect(ray, false);
            ++rays;
            if (hit.instance < 0 || hit.distance >= distance) return through;
            through *= 1 - opacity_at(scene_, hit);
            pass(ray, hit);
        }
        return through;
    }

    /// All paths of a batch to their ends.
    std::int64_t run(std::span<Path> paths, LightBatch& light) const {
        std::int64_t rays = 0;
        std::vector<Path*> alive, next;
        for (Path& p : paths) alive.push_back(&p);
        for (int bounce = 0; !alive.empty(); ++bounce) {
            // What the rays met.
            next.clear();
            for (Path* p : alive)
                if (arrive(*p, bounce, rays)) next.push_back(p);
            std::swap(alive, next);
            // A light direction for each, all at once.
            const bool draw = options_.strategy != LightStrategy::brdf && !alive.empty();
            const int n = int(alive.size());
            if (draw) {
                for (int i = 0; i < n; ++i) light.points[i] = alive[i]->point(light_pair(bounce));
                sampler_.sample(std::span(light.points.data(), std::size_t(n)), light.spans(n));
            }
            next.clear();
            for (int i = 0; i < n; ++i) {
                Path& p = *alive[i];
                const Frame<float> frame(p.surface.normal);
                p.V = frame.to_local(-p.ray.direction);
                if (draw) light_up(p, frame, light.direction(i), light.radiance(i), light.pdf(i), bounce, rays);
                for (const PunctualLight& l : scene_.lights) light_up(p, frame, l, bounce, rays);
                if (scatter(p, frame, bounce, rays)) next.push_back(&p);
            }
            std::swap(alive, next);
        }
        return rays;
    }

    /// Traces a path's ray; adds what shines along it. Whether there is a surface to light.
    bool arrive(Path& p, int bounce, std::int64_t& rays) const {
        if (!find(p, bounce, rays)) {
            escape(p, bounce);
            return false;
        }
        p.surface = surface_at(scene_, p.hit, p.ray.origin, p.ray.direction, options_.multiple_scattering);
        const SurfacePoint& s = p.surface;
        if (bounce == 0) {
            p.covered = true;
            p.albedo = s.albedo;
            p.normal = s.normal;
            p.depth = p.hit.distance;
            p.object = p.hit.instance + 1;
        }
        if (const Vec3f e = product(p.throughput, s.emission); largest(e) > 0) {
            p.radiance = p.radiance + e;
            (bounce <= 1 ? p.direct : p.indirect) = (bounce <= 1 ? p.direct : p.indirect) + e;
            if (bounce > 0) {
                const Vec3f below = product(e, p.diffuse_share);
                p.diffuse = p.diffuse + below;
                p.specular = p.specular + (e - below);
            }
        }
        return !s.unlit;
    }

    /// A ray that met nothing: the background, or the environment as the BRDF's half of direct light.
    void escape(Path& p, int bounce) const {
        if (bounce == 0) {
            if (options_.background == Background::environment) p.radiance = sampler_.radiance(p.ray.direction);
            return;
        }
        if (options_.strategy == LightStrategy::environment) return;
        const LightSample light = sampler_.look_up(p.ray.direction);
        const float weight =
            options_.strategy == LightStrategy::brdf ? 1 : p.pdf_brdf / (p.pdf_brdf + light.pdf_solid_angle);
        p.add(product(p.throughput, light.radiance) * weight, bounce - 1);
    }

    /// A direction drawn from the environment.
    void light_up(Path& p, const Frame<float>& frame, const Vec3f& direction, const Vec3f& radiance, float pdf,
                  int bounce, std::int64_t& rays) const {
        const Vec3f L = frame.to_local(direction);
        if (!(L.z > 0) || largest(radiance) <= 0) return;
        const Bsdf::Value f = p.surface.bsdf.evaluate(p.V, L);
        if (largest(f.sum()) <= 0) return;
        const float seen = visibility(p.surface, direction, rays);
        if (seen <= 0) return;
        const float other = options_.strategy == LightStrategy::mis ? p.surface.bsdf.pdf_solid_angle(p.V, L) : 0;
        // The balance heuristic's weight over the density: 1 / (p_light + p_brdf).
        p.add(f, product(p.throughput, radiance) * (seen * L.z / (pdf + other)), bounce);
    }

    /// A light of the scene's own.
    void light_up(Path& p, const Frame<float>& frame, const PunctualLight& light, int bounce,
                  std::int64_t& rays) const {
        Vec3f direction = -light.direction;
        float distance = std::numeric_limits<float>::infinity(), strength = 1;
        if (light.kind != PunctualLight::Kind::directional) {
            const Vec3f to = light.position - p.surface.position;
            const float squared = dot(to, to);
            distance = std::sqrt(squared);
            if (!(distance > 0)) return;
            direction = to / distance;
            // KHR_lights_punctual, "Range property": falls to nothing at the range.
            const float part = distance / light.range, fall = std::clamp(1 - part * part * part * part, 0.f, 1.f);
            strength = fall / squared;
            if (light.kind == PunctualLight::Kind::spot) {
                const float cosine = -dot(direction, light.direction);
                const float edge = std::clamp(
                    (cosine - light.cos_outer) / std::max(0.001f, light.cos_inner - light.cos_outer), 0.f, 1.f);
                strength *= edge * edge;
            }
        }
        const Vec3f L = frame.to_local(direction);
        if (!(L.z > 0) || strength <= 0) return;
        const Bsdf::Value f = p.surface.bsdf.evaluate(p.V, L);
        if (largest(f.sum()) <= 0) return;
        p.add(f,
              product(p.throughput, light.intensity) *
                  (strength * L.z * visibility(p.surface, direction, rays, distance)),
              bounce);
    }

    /// Sends the path on by the BRDF. Whether there is more to come of it.
    bool scatter(Path& p, const Frame<float>& frame, int bounce, std::int64_t& rays) const {
        const bool last = bounce >= options_.bounces || !options_.occlusion;
        // Nothing beyond, and no light that way either.
        if (last && options_.strategy == LightStrategy::environment) return false;
        const SurfacePoint& s = p.surface;
        const Bsdf::Sample b = s.bsdf.sample(p.V, p.point(brdf_pair(bounce)));
        if (!(b.pdf_solid_angle > 0)) return false;
        const Vec3f direction = frame.to_world(b.L);
        if (options_.occlusion && dot(direction, s.geometric_normal) <= 0) return false;
        const Bsdf::Value f = s.bsdf.evaluate(p.V, b.L);
        const Vec3f sum = f.sum();
        if (bounce == 0) {
            const auto share = [](float part, float all) { return all > 0 ? part / all : 0; };
            p.diffuse_share = {share(f.diffuse.x, sum.x), share(f.diffuse.y, sum.y), share(f.diffuse.z, sum.z)};
        }
        p.throughput = product(p.throughput, sum) * (b.L.z / b.pdf_solid_angle);
        if (!(largest(p.throughput) > 0)) return false;
        p.pdf_brdf = b.pdf_solid_angle;
        if (last) {
            // Only the environment can still be met: whether it is takes less than finding what hides it.
            if (const float seen = visibility(s, direction, rays); seen > 0) {
                p.throughput = p.throughput * seen;
                p.ray.direction = direction;
                escape(p, bounce + 1);
            }
            return false;
        }
        if (bounce >= k_roulette_from) {
            const float survive = std::min(0.95f, largest(p.throughput));
            if (unit_float(p.point(chance_pair(bounce)).y) >= survive) return false;
            p.throughput = p.throughput / survive;
        }
        p.ray = {s.position + s.geometric_normal * s.error, direction, 0};
        return true;
    }

    static void store(const Path& p, PixelSums& s) {
        const Vec3d r(p.radiance);
        if (!(std::isfinite(r.x) && std::isfinite(r.y) && std::isfinite(r.z))) {
            ++s.count;
            return;
        }
        s.radiance = s.radiance + r;
        s.squares = s.squares + Vec3d{r.x * r.x, r.y * r.y, r.z * r.z};
        s.direct = s.direct + p.direct;
        s.indirect = s.indirect + p.indirect;
        s.diffuse = s.diffuse + p.diffuse;
        s.specular = s.specular + p.specular;
        s.albedo = s.albedo + p.albedo;
        s.normal = s.normal + p.normal;
        if (p.covered) {
            s.depth += p.depth;
            s.covered += 1;
        }
        if (s.count == 0) s.object = float(p.object);
        ++s.count;
    }

    const RayScene::Impl& rays_;
    const Scene& scene_;
    const EnvironmentSampler& sampler_;
    const RenderOptions& options_;
    CameraRays camera_;
    bool passages_;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

EnvironmentSamplerOptions reference_sampler_options(LightStrategy strategy, int threads) {
    EnvironmentSamplerOptions options;
    options.method = DistributionMethod::bilinear;
    options.compensate = strategy == LightStrategy::mis;
    options.threads = threads;
    return options;
}

Result<RenderResult> render_reference(const RayScene& scene, const EnvironmentSampler& sampler,
                                      const RenderOptions& o) {
    if (auto fine = check_size(o.width, o.height); !fine) return fine.error();
    if (o.strategy == LightStrategy::environment && sampler.compensation() > 0)
        return Error{"a sampler with MIS compensation leaves out light that this strategy has no other way to find", "",
                     "Build it with reference_sampler_options(strategy)."};
    const auto start = std::chrono::steady_clock::now();
    const Tracer tracer(scene, sampler, o);
    Film film(o.width, o.height);
    std::atomic<std::int64_t> rays{0};
    std::atomic<bool> cancelled{false};
    std::atomic<int> tiles_done{0};
    std::mutex progress_mutex;

    // One round: wanted(x, y) more samples for each pixel.
    const auto round = [&](const auto& wanted, double from, double to) {
        tiles_done = 0;
        parallel_for(film.tiles(), o.threads, [&](int t) {
            if (cancelled) return;
            const int columns = film.columns(t);
            std::vector<int> count(film.tile(t).size());
            for (int i = 0; i < int(count.size()); ++i)
                count[i] = wanted(film.x0(t) + i % columns, film.y0(t) + i / columns);
            rays += tracer.trace(film.x0(t), film.y0(t), columns, count, film.tile(t));
            const int done = ++tiles_done;
            if (o.progress) {
                const std::lock_guard lock(progress_mutex);
                if (!o.progress("render", from + (to - from) * done / film.tiles())) cancelled = true;
            }
        });
    };

    if (o.seconds > 0) {
        // Rounds that double, as long as the next one is likely to fit.
        int total = 0;
        for (int add = 1; !cancelled; add = std::max(1, total)) {
            const double spent = seconds_since(start), left = o.seconds - spent;
            if (total > 0) {
                if (left <= 0 || total >= o.most_samples) break;
                add = std::min({add, o.most_samples - total, std::max(1, int(left / spent * total))});
                if (left < spent / total) break;
            }
            round([&](int, int) { return add; }, std::min(1.0, spent / o.seconds),
                  std::min(1.0, 2 * spent / o.seconds));
            total += add;
        }
    } else {
        round([&](int, int) { return std::max(1, o.samples); }, 0, o.noise > 0 ? 0.3 : 1);
        for (int k = 0; o.noise > 0 && !cancelled && k < 24; ++k) {
            // Decided for all pixels before any is changed.
            ImageF wanted(o.width, o.height, 1);
            bool any = false;
            parallel_ranges(o.height, 8, o.threads, [&](int begin, int end) {
                for (int y = begin; y < end; ++y)
                    for (int x = 0; x < o.width; ++x) {
                        const int count = film.at(x, y).count;
                        if (count < o.most_samples && film.noise_about(x, y) > o.noise)
                            *wanted.at(x, y) = float(std::min(count, o.most_samples - count));
                    }
            });
            for (const float w : wanted.pixels()) any |= w > 0;
            if (!any) break;
            round([&](int x, int y) { return int(*wanted.at(x, y)); }, 0.3 + 0.7 * k / (k + 1.0),
                  0.3 + 0.7 * (k + 1.0) / (k + 2.0));
        }
    }
    if (cancelled) return Error{"cancelled", "", ""};
    RenderResult out = develop(film, o.width, o.height);
    out.rays = rays;
    out.seconds = seconds_since(start);
    return out;
}

}  // namespace domelight
