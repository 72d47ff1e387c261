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
            const Vec3f next = probe.position + step(around);
            if (length(next - wanted) > options_.farthest) break;
            probe.position = next, probe.moved = true;
            around = look(next);
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

    /// Through the nearest back, or away from the nearest front, to a little more than the distance that a probe keeps.
    Vec3f step(const Surroundings& around) const {
        const float keep = 1.01f * options_.nearest;
        return around.inside() ? around.to_back * (around.back_distance + keep)
                               : around.to_front * (around.front_distance - keep);
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
