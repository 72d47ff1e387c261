#include "domelight/base/parallel.h"
#include "domelight/capture/capture.h"
#include "domelight/capture/placement.h"

#include "base/field_place.h"
#include "capture/sphere_directions.h"
#include "capture/surroundings.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>

namespace domelight {
namespace {

/// How often a place is moved before it is given up.
constexpr int k_moves = 8;

class Placer {
  public:
    Placer(const RayScene& scene, const RelocationOptions& options)
        : scene_(scene), options_(options), directions_(sphere_directions(options.rays)) {}

    Probe place(const Vec3f& wanted) const {
        Probe probe{.place = wanted, .position = wanted};
        Surroundings around = look(wanted);
        const bool inside = around.inside();
        for (int move = 0; move < k_moves; ++move) {
            if (!around.inside() && around.front_distance >= options_.nearest) return probe;
            const auto next =
                around.inside() ? way_out(probe.position, wanted) : away_from_front(around, probe.position);
            if (!next || length(*next - wanted) > options_.farthest) break;
            probe.position = *next, probe.moved = true;
            around = look(*next);
        }
        // A place near a surface is better than none: it stays where it was asked for, if that is outside of bodies.
        probe.position = wanted, probe.moved = false;
        probe.valid = !inside;
        return probe;
    }

  private:
    Surroundings look(const Vec3f& from) const {
        const Surroundings around = look_around(scene_, from, directions_);
        if (!options_.light || around.inside() || around.surfaces < 1) return around;
        const Surroundings with_double_sided = look_around(scene_, from, directions_, Backs::all);
        return with_double_sided.inside() && is_dark(from) ? with_double_sided : around;
    }

    /// Whether no light at all arrives, as far as a small capture can tell.
    bool is_dark(const Vec3f& at) const {
        CaptureOptions options;
        options.size = 8, options.samples = 16, options.bounces = 2;
        bool dark = true;
        const int number = 0;
        // Its options are valid, and nothing cancels it.
        (void)capture(scene_, *options_.light, {&at, 1}, {&number, 1}, options,
                      [&](int, CapturedCube cube) -> Result<void> {
                          dark = std::ranges::all_of(cube.radiance.pixels(), [](float v) { return v == 0; });
                          return {};
                      });
        return dark;
    }

    /// How far behind or before a surface a probe is moved to.
    float keep() const { return 1.01f * options_.nearest; }

    std::optional<Vec3f> away_from_front(const Surroundings& around, const Vec3f& from) const {
        return from + around.to_front * (around.front_distance - keep());
    }

    /// From inside of a body through one of the surfaces around: to where the fewest rays meet backs, which is not
    /// behind the wall that the body stands at, and the nearest of these.
    std::optional<Vec3f> way_out(const Vec3f& from, const Vec3f& wanted) const {
        std::optional<Vec3f> best;
        std::pair<float, float> least{0.25f, 0};  // the share of backs, and the distance
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z) {
                    if (x == 0 && y == 0 && z == 0) continue;
                    const Vec3f direction = normalize(Vec3f{float(x), float(y), float(z)});
                    const float distance = surface_along(scene_, from, direction).distance + keep();
                    const Vec3f out = from + direction * distance;
                    if (!(length(out - wanted) <= options_.farthest)) continue;
                    const std::pair<float, float> found{look(out).backs, distance};
                    if (found < least) least = found, best = out;
                }
        return best;
    }

    const RayScene& scene_;
    const RelocationOptions& options_;
    std::vector<Vec3f> directions_;
};

Result<void> check(std::span<const Vec3f> places, const RelocationOptions& o) {
    if (!(o.nearest > 0) || !std::isfinite(o.nearest))
        return Error{fmt::format("{} is not a distance above 0", o.nearest), field_place("nearest"), ""};
    if (!(o.farthest >= 0) || !std::isfinite(o.farthest))
        return Error{fmt::format("{} is not a distance", o.farthest), field_place("farthest"), ""};
    if (o.rays < 16 || o.rays > 65536)
        return Error{fmt::format("{} is not from 16 to 65536", o.rays), field_place("rays"), ""};
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Vec3f& p = places[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            return Error{fmt::format("number {}, ({}, {}, {}), is not finite", i, p.x, p.y, p.z), field_place("places"),
                         ""};
    }
    return {};
}

}  // namespace

Result<std::vector<Probe>> place_probes(const RayScene& scene, std::span<const Vec3f> places,
                                        const RelocationOptions& options) {
    if (auto ok = check(places, options); !ok) return ok.error();
    const Placer placer(scene, options);
    std::vector<Probe> probes(places.size());
    std::atomic<bool> cancelled{false};
    std::mutex progress;
    int done = 0;
    parallel_for(int(places.size()), options.threads, [&](int i) {
        if (cancelled) return;
        probes[std::size_t(i)] = placer.place(places[std::size_t(i)]);
        if (!options.progress) return;
        const std::lock_guard lock(progress);
        if (!options.progress("place", double(++done) / double(places.size()))) cancelled = true;
    });
    if (cancelled) return Error{"cancelled", "", ""};
    return probes;
}

}  // namespace domelight
