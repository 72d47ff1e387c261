// Path tracing with next-event estimation: at each surface one light direction from the environment, one to a point of
// the surfaces that emit light, and one from the BRDF, weighted by the balance heuristic (Veach 1997, 9.2.2); the BRDF's
// ray continues the path if there are bounces left. All samples of a tile take each step together, so that the
// environment is sampled in batches.

#include "render/path_tracer.h"

#include "render/background.h"
#include "render/camera.h"
#include "render/path.h"
#include "render/punctual.h"
#include "render/surface/surface_lobes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace domelight {
namespace {

constexpr int k_most_passages = 64;  ///< the largest number of transparent surfaces that a ray passes
constexpr int k_roulette_from = 3;   ///< bounces before paths may be ended at random
constexpr float k_infinite = std::numeric_limits<float>::infinity();

class Tracer final : public TileTracer {
  public:
    Tracer(const RayScene& scene, const EnvironmentSampler& sampler, const RenderOptions& options)
        : rays_(scene.impl()),
          scene_(scene.scene()),
          sampler_(sampler),
          options_(options),
          lights_(all_lights(scene_, options)),
          camera_(options.camera, options.width, options.height),
          passages_(has_passages(scene_)),
          layers_(has_layers(scene_)),
          draws_emitters_(!rays_.emitters.empty() && options.occlusion && options.strategy != LightStrategy::brdf) {}

    std::int64_t trace(int x0, int y0, int columns, std::span<const int> count,
                       std::span<PixelSums> sums) const override {
        Workspace room;
        std::vector<PathLayers> layers(layers_ ? k_path_batch : 0);
        std::vector<Path>& paths = room.paths;
        std::int64_t rays = 0;
        const auto flush = [&] {
            rays += run(room);
            for (const Path& p : paths) store(p, sums[p.pixel]);
            paths.clear();
        };
        for (int pixel = 0; pixel < int(count.size()); ++pixel) {
            const int x = x0 + pixel % columns, y = y0 + pixel / columns;
            const int first = sums[pixel].count;
            for (int i = 0; i < count[pixel]; ++i) {
                paths.emplace_back();
                start(paths.back(), pixel, x, y, std::uint32_t(first + i));
                if (layers_) {
                    paths.back().layers = &layers[paths.size() - 1];
                    paths.back().layers->inside = false;
                }
                if (int(paths.size()) == k_path_batch) flush();
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

    /// The nearest surface that stops the ray.
    bool find(Path& p, int bounce, std::int64_t& rays) const {
        for (int passage = 0; passage < k_most_passages; ++passage) {
            p.hit = rays_.intersect(p.ray, bounce == 0);
            ++rays;
            if (p.hit.instance < 0) return false;
            if (!passages_) return true;
            const float opacity = opacity_at(scene_, p.hit);
            if (opacity >= 1) return true;
            // At random, with a different number for each surface passed.
            if (opacity > 0 && unit_float(sobol_owen(derive_key(derive_key(p.key, std::uint64_t(chance_pair(bounce))),
                                                                std::uint64_t(passage)),
                                                     p.index)
                                              .x) < opacity)
                return true;
            pass(p.ray, p.hit);
        }
        return false;
    }

    /// The part of the light from a direction that arrives.
    float visibility(const SurfacePoint& s, const Vec3f& direction, std::int64_t& rays, float distance) const {
        if (!options_.occlusion) return 1;
        if (s.blocks(direction)) return 0;
        Ray ray = s.ray_to(direction, distance);
        if (!passages_) {
            ++rays;
            return rays_.occluded(ray) ? 0 : 1;
        }
        float through = 1;
        for (int passage = 0; passage < k_most_passages && through > 0; ++passage) {
            const Hit hit = rays_.intersect(ray, false);
            ++rays;
            if (hit.instance < 0) return through;
            through *= 1 - opacity_at(scene_, hit);
            pass(ray, hit);
        }
        return through;
    }

    /// Traces all paths of a batch to their ends.
    std::int64_t run(Workspace& room) const {
        std::int64_t rays = 0;
        std::vector<Path*> alive, next;
        for (Path& p : room.paths) alive.push_back(&p);
        for (int bounce = 0; !alive.empty(); ++bounce) {
            find(alive, bounce, room, rays);
            next.clear();
            for (Path* p : alive) {
                if (p->layers) travel(*p);
                if (p->hit.instance >= 0) {
                    if (arrive(*p, bounce)) next.push_back(p);
                } else
                    room.endings.push_back({p, p->ray.direction});
            }
            escape(room, bounce - 1);
            std::swap(alive, next);
            // Draws a light direction for each path, all at once.
            const bool draw = options_.strategy != LightStrategy::brdf && !alive.empty();
            const int n = int(alive.size());
            LightBatch& light = room.light;
            if (draw) {
                for (int i = 0; i < n; ++i) light.points[i] = alive[i]->point(light_pair(bounce));
                sampler_.sample(std::span(light.points.data(), std::size_t(n)), light.spans(n));
            }
            next.clear();
            for (int i = 0; i < n; ++i) {
                Path& p = *alive[i];
                const Frame<float> frame(p.surface.normal);
                p.V = frame.to_local(-p.ray.direction);
                if (draw) light_up(p, frame, {light.direction(i), light.radiance(i), light.pdf(i)}, bounce, room, rays);
                p.drew_emitter = draws_emitters_ && bounce - p.passages < options_.bounces;
                if (p.drew_emitter) draw_emitter(p, frame, bounce, room, rays);
                for (const PunctualLight& l : lights_) light_up(p, frame, l, bounce, rays);
                if (scatter(p, frame, bounce, room)) next.push_back(&p);
            }
            settle(room, bounce, rays);
            end(room, bounce, rays);
            std::swap(alive, next);
        }
        return rays;
    }

    /// Finds the surfaces that the paths' rays hit.
    void find(std::span<Path* const> paths, int bounce, Workspace& room, std::int64_t& rays) const {
        if (passages_ || bounce > 0) {
            for (Path* p : paths)
                if (!find(*p, bounce, rays)) p->hit.instance = -1;
            return;
        }
        in_packets(
            paths, [](const Path* p) -> const Ray& { return p->ray; },
            [&](std::span<const Ray* const> packet, std::size_t first) {
                rays_.intersect(packet, std::span(room.hits).first(packet.size()));
                for (std::size_t i = 0; i < packet.size(); ++i) paths[first + i]->hit = room.hits[i];
            });
        rays += std::int64_t(paths.size());
    }

    template <typename Items, typename RayOf, typename Use>
    static void in_packets(const Items& items, const RayOf& ray_of, const Use& use) {
        const Ray* packet[RayScene::Impl::k_packet];
        for (std::size_t first = 0; first < items.size(); first += std::size(packet)) {
            const std::size_t n = std::min(std::size(packet), items.size() - first);
            for (std::size_t i = 0; i < n; ++i) packet[i] = &ray_of(items[first + i]);
            use(std::span<const Ray* const>(packet, n), first);
        }
    }

    /// Traces the shadow rays that are waiting, and adds the light that is not occluded.
    void settle(Workspace& room, int bounce, std::int64_t& rays) const {
        in_packets(
            room.shadows, [](const Shadow& s) -> const Ray& { return s.ray; },
            [&](std::span<const Ray* const> packet, std::size_t first) {
                const std::uint32_t hidden = rays_.occluded(packet);
                for (std::size_t i = 0; i < packet.size(); ++i) {
                    const Shadow& s = room.shadows[first + i];
                    if (!(hidden >> i & 1)) s.path->add(s.diffuse, s.specular, bounce);
                }
            });
        rays += std::int64_t(room.shadows.size());
        room.shadows.clear();
    }

    /// Adds light to a path unless it is occluded: either now, or when its shadow ray is traced with the others.
    void add_if_seen(Path& p, const Vec3f& direction, float distance, const Vec3f& diffuse, const Vec3f& specular,
                     int bounce, Workspace& room, std::int64_t& rays) const {
        const SurfacePoint& s = p.surface;
        if (options_.occlusion && !passages_) {
            if (!s.blocks(direction)) room.shadows.push_back({&p, s.ray_to(direction, distance), diffuse, specular});
            return;
        }
        if (const float seen = visibility(s, direction, rays, distance); seen > 0)
            p.add(diffuse * seen, specular * seen, bounce);
    }

    /// At a surface: adds its emission. Returns whether there is a surface to be lit.
    bool arrive(Path& p, int bounce) const {
        if (p.layers) {
            const UnitPoint shift = options_.multiple_scattering ? p.point(shift_pair(bounce)) : UnitPoint{};
            p.surface = surface_at(scene_, p.hit, p.ray.origin, p.ray.direction, options_.multiple_scattering,
                                   &p.layers->bsdf, shift);
            // Without shadows, light can come from every side.
            if (!options_.occlusion) p.layers->bsdf.geometric_normal = {0, 0, 1};
        } else {
            p.surface = surface_at(scene_, p.hit, p.ray.origin, p.ray.direction, options_.multiple_scattering);
        }
        const SurfacePoint& s = p.surface;
        if (bounce == 0) {
            p.covered = true;
            p.albedo = s.albedo;
            p.normal = s.normal;
            p.depth = p.hit.distance;
            p.object = p.hit.instance + 1;
        }
        if (const Vec3f e = product(p.throughput, s.emission) * emission_weight(p); largest(e) > 0) {
            p.radiance += e;
            const bool first = bounce - p.passages <= 1;
            (first ? p.direct : p.indirect) = (first ? p.direct : p.indirect) + e;
            if (bounce > 0) {
                const Vec3f below = product(e, p.diffuse_share);
                p.diffuse += below;
                p.specular += (e - below);
            }
        }
        return !s.unlit;
    }

    /// The weight of the emission that the BRDF's ray has found beside that of a point drawn from the emitters.
    float emission_weight(const Path& p) const {
        if (!p.drew_emitter || largest(p.surface.emission) <= 0) return 1;
        const float pdf = rays_.emitters.pdf_solid_angle(p.hit, p.ray.direction);
        if (pdf <= 0) return 1;
        return options_.strategy == LightStrategy::environment ? 0 : p.pdf_brdf / (p.pdf_brdf + pdf);
    }

    /// Rays that hit nothing: they add the background, or the environment as the BRDF's half of direct light.
    void escape(Workspace& room, int bounce) const {
        if (bounce < 0) {
            if (options_.background == Background::environment) {
                look_up(room, false);
                for (std::size_t i = 0; i < room.endings.size(); ++i)
                    room.endings[i].path->radiance = room.light.radiance(int(i));
            } else {
                for (const auto& ending : room.endings)
                    ending.path->radiance = background_radiance(options_, sampler_, ending.direction);
            }
        } else if (options_.strategy != LightStrategy::environment) {
            look_up(room, options_.strategy == LightStrategy::mis);
            for (std::size_t i = 0; i < room.endings.size(); ++i) {
                Path& p = *room.endings[i].path;
                p.add(product(p.throughput, weighted(room.light.radiance(int(i)), room.light.pdf(int(i)), p.pdf_brdf)),
                      bounce);
            }
        }
        room.endings.clear();
    }

    /// The last rays of paths: they can only reach the environment, so testing for any occluder is enough, which is
    /// faster than finding the nearest one.
    void end(Workspace& room, int bounce, std::int64_t& rays) const {
        look_up(room, options_.strategy == LightStrategy::mis);
        for (std::size_t i = 0; i < room.endings.size(); ++i) {
            Path& p = *room.endings[i].path;
            const Vec3f light = product(p.throughput,
                                        weighted(room.light.radiance(int(i)), room.light.pdf(int(i)), p.pdf_brdf)),
                        below = product(light, p.diffuse_share);
            if (largest(light) > 0)
                add_if_seen(p, room.endings[i].direction, k_infinite, below, light - below, bounce, room, rays);
        }
        room.endings.clear();
        settle(room, bounce, rays);
    }

    /// Looks up the environment in the directions of the last rays, into room.light.
    void look_up(Workspace& room, bool densities) const {
        LightSampleSpans spans = room.light.spans(int(room.endings.size()));
        for (std::size_t i = 0; i < room.endings.size(); ++i) {
            const Vec3f& d = room.endings[i].direction;
            spans.x[i] = d.x, spans.y[i] = d.y, spans.z[i] = d.z;
        }
        if (!densities) spans.pdf_solid_angle = {};
        sampler_.look_up(spans);
    }

    /// Light from the direction of the BRDF's ray, weighted by the balance heuristic.
    Vec3f weighted(const Vec3f& radiance, float pdf_light, float pdf_brdf) const {
        return options_.strategy == LightStrategy::brdf ? radiance : radiance * (pdf_brdf / (pdf_brdf + pdf_light));
    }

    /// A point drawn from the surfaces that emit light.
    void draw_emitter(Path& p, const Frame<float>& frame, int bounce, Workspace& room, std::int64_t& rays) const {
        const Vec3f& place = p.surface.position;
        const EmitterSample e = rays_.emitters.sample(scene_, place, p.point(emitter_pair(bounce)));
        if (e.hit.instance < 0) return;
        Vec3f radiance = emission_at(scene_, e.hit, place, e.direction, options_.multiple_scattering);
        if (passages_) radiance *= opacity_at(scene_, e.hit);
        if (p.layers) radiance = product(radiance, through_body(p, e));
        light_up(p, frame, {e.direction, radiance, e.pdf_solid_angle, e.hit.distance}, bounce, room, rays);
    }

    /// A direction from which light arrives, drawn from the environment or from the emitters.
    struct DrawnLight {
        Vec3f direction, radiance;
        float pdf_solid_angle;
        float distance = k_infinite;  ///< to the surface that emits it
    };
    void light_up(Path& p, const Frame<float>& frame, const DrawnLight& drawn, int bounce, Workspace& room,
                  std::int64_t& rays) const {
        const Vec3f L = frame.to_local(drawn.direction);
        if (!(L.z > 0 || p.surface.layers) || largest(drawn.radiance) <= 0) return;
        const Bsdf::Value f = p.surface.evaluate_cosine(p.V, L);
        if (largest(f.sum()) <= 0) return;
        const float other = options_.strategy == LightStrategy::mis ? p.surface.pdf_solid_angle(p.V, L) : 0;
        // The balance heuristic's weight over the density: 1 / (p_light + p_brdf).
        const bool far = std::isinf(drawn.distance);
        const Vec3f arriving = far ? through_sheet(p.surface, L, drawn.radiance) : drawn.radiance;
        const Vec3f light = product(p.throughput, arriving) * (1 / (drawn.pdf_solid_angle + other));
        add_if_seen(p, drawn.direction, drawn.distance, product(f.diffuse, light), product(f.specular, light), bounce,
                    room, rays);
    }

    /// A light of the scene.
    void light_up(Path& p, const Frame<float>& frame, const PunctualLight& light, int bounce,
                  std::int64_t& rays) const {
        const auto [direction, distance, strength] = arrival_at(light, p.surface.position);
        if (strength <= 0) return;
        const Vec3f L = frame.to_local(direction);
        if (!(L.z > 0 || p.surface.layers)) return;
        const Bsdf::Value f = p.surface.evaluate_cosine(p.V, L);
        if (largest(f.sum()) <= 0) return;
        const Vec3f arriving = product(p.throughput, through_sheet(p.surface, L, light.intensity)) *
                               (strength * visibility(p.surface, direction, rays, distance));
        p.add(product(f.diffuse, arriving), product(f.specular, arriving), bounce);
    }

    /// Light that reaches the inside of a body's surface although the body has no other side in this direction, or
    /// occlusion is off: it can then only have come through a sheet.
    static Vec3f through_sheet(const SurfacePoint& s, const Vec3f& L, const Vec3f& light) {
        if (!s.layers || !s.layers->volume || !s.front || L.z > 0) return light;
        return product(light, s.layers->through(s.layers->thickness));
    }

    /// The part of an emitter's light that the body between it and a path's surface leaves (Beer's law).
    static Vec3f through_body(const Path& p, const EmitterSample& e) {
        const LayeredBsdf* layers = p.surface.layers;
        const bool enters = layers && layers->volume && dot(e.direction, p.surface.geometric_normal) < 0;
        if (enters ? !p.surface.front : !p.layers->inside) return {1, 1, 1};
        return (enters ? *layers : p.layers->body).through(e.hit.distance);
    }

    /// Continues the path by sampling the BRDF. Returns whether the path goes on.
    bool scatter(Path& p, const Frame<float>& frame, int bounce, Workspace& room) const {
        const SurfacePoint& s = p.surface;
        bool last = bounce - p.passages >= options_.bounces || !options_.occlusion;
        // Nothing follows, and no light comes from there either.
        if (last && options_.strategy == LightStrategy::environment && !s.layers) return false;
        const UnitPoint u = p.point(brdf_pair(bounce));
        const Bsdf::Sample b =
            s.layers ? s.layers->sample(p.V, u, unit_float(p.point(chance_pair(bounce)).x)) : s.bsdf.sample(p.V, u);
        if (!(b.pdf_solid_angle > 0)) return false;
        const Vec3f direction = frame.to_world(b.L);
        if (options_.occlusion && s.blocks(direction)) return false;
        const Bsdf::Value f = s.evaluate_cosine(p.V, b.L);
        const Vec3f sum = f.sum();
        if (bounce == 0) {
            const auto share = [](float part, float all) { return all > 0 ? part / all : 0; };
            p.diffuse_share = {share(f.diffuse.x, sum.x), share(f.diffuse.y, sum.y), share(f.diffuse.z, sum.z)};
        }
        p.throughput = product(p.throughput, sum) * (1 / b.pdf_solid_angle);
        if (!(largest(p.throughput) > 0)) return false;
        p.pdf_brdf = b.pdf_solid_angle;
        if (s.layers && pass_boundary(p, options_.occlusion ? dot(direction, s.geometric_normal) < 0 : b.L.z < 0))
            last = false;
        if (last) {
            if (options_.strategy == LightStrategy::environment) return false;
            if (p.layers) leave(p);
            room.endings.push_back({&p, direction});
            return false;
        }
        if (bounce >= k_roulette_from) {
            const float survive = std::min(0.95f, largest(p.throughput));
            if (unit_float(p.point(chance_pair(bounce)).y) >= survive) return false;
            p.throughput = p.throughput / survive;
        }
        p.ray = s.ray_to(direction);
        return true;
    }

    /// Keeps track of the body that the path is in. Returns whether the path continues without counting a bounce:
    /// through a surface, or inside a body, up to the allowed number.
    bool pass_boundary(Path& p, bool behind) const {
        const LayeredBsdf& layers = *p.surface.layers;
        const bool passage = behind || (layers.volume && !p.surface.front);
        if (layers.volume && behind) {
            p.layers->inside = p.surface.front;
            if (p.surface.front) p.layers->body = layers;
        }
        p.passing = passage && p.passages < options_.refractions && options_.occlusion;
        return p.passing;
    }

    /// Counts the passage of a path's ray, and applies the absorption of the body that it crossed (Beer's law).
    static void travel(Path& p) {
        p.passages += p.passing;
        p.passing = false;
        if (p.hit.instance < 0)
            leave(p);
        else if (p.layers->inside)
            p.throughput = product(p.throughput, p.layers->body.through(p.hit.distance));
    }
    /// A body whose other side was not found is a sheet of its stated thickness.
    static void leave(Path& p) {
        if (p.layers->inside) p.throughput = product(p.throughput, p.layers->body.through(p.layers->body.thickness));
    }

    static void store(const Path& p, PixelSums& s) {
        const Vec3d r(p.radiance);
        if (!s.accepts(r)) return;
        s.radiance += r;
        s.squares += Vec3d{r.x * r.x, r.y * r.y, r.z * r.z};
        s.direct += p.direct;
        s.indirect += p.indirect;
        s.diffuse += p.diffuse;
        s.specular += p.specular;
        s.albedo += p.albedo;
        s.normal += p.normal;
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
    const std::vector<PunctualLight> lights_;
    CameraRays camera_;
    bool passages_;
    bool layers_;
    bool draws_emitters_;
};

}  // namespace

std::unique_ptr<TileTracer> make_path_tracer(const RayScene& scene, const EnvironmentSampler& sampler,
                                             const RenderOptions& options) {
    return std::make_unique<Tracer>(scene, sampler, options);
}

}  // namespace domelight
