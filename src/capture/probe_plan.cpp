#include "domelight/capture/probe_plan.h"

#include "domelight/capture/probe_rooms.h"

#include "base/field_place.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace domelight {
namespace {

/// The part of a box or sphere of influence over which it fades.
constexpr float k_fade = 0.1f;

bool wants_grid(const ProbePlanOptions& o) {
    return o.grid != std::array<int, 3>{0, 0, 0};
}

Result<void> check(const ProbePlanOptions& o) {
    const int ways = int(!o.at.empty()) + int(wants_grid(o)) + int(o.density != 0) + int(o.auto_count != 0);
    if (ways != 1)
        return Error{fmt::format("{} of the ways to place probes are set", ways == 0 ? "none" : "several"),
                     field_place("at"), "Set one of `at`, `grid`, `density` and `auto`."};
    if (o.influence == ProbeInfluence::Shape::sphere && !(o.radius > 0 && std::isfinite(o.radius)))
        return Error{fmt::format("{} is not a distance above 0", o.radius), field_place("radius"), ""};
    return {};
}

ProbeBox region_of(const ProbePlanOptions& o, const Scene& scene) {
    if (o.region) return *o.region;
    const Scene::Box bounds = scene.bounds();
    return {bounds.low, bounds.high};
}

/// The least distance between neighbours in a grid; 0 where there are none.
float least_spacing(const std::optional<ProbeGrid>& grid) {
    float least = std::numeric_limits<float>::infinity();
    if (grid && grid->nx > 1) least = std::min(least, grid->spacing.x);
    if (grid && grid->ny > 1) least = std::min(least, grid->spacing.y);
    if (grid && grid->nz > 1) least = std::min(least, grid->spacing.z);
    return std::isinf(least) ? 0 : least;
}

Result<std::optional<ProbeGrid>> grid_for(const ProbePlanOptions& o, const Scene& scene) {
    if (!o.at.empty()) return std::optional<ProbeGrid>();
    const ProbeBox region = region_of(o, scene);
    const auto grid =
        wants_grid(o) ? grid_over(region, o.grid[0], o.grid[1], o.grid[2]) : grid_over(region, {.density = o.density});
    if (!grid) return grid.error();
    return std::optional(*grid);
}

Result<ProbePlan> placed_automatically(const RayScene& scene, const EnvironmentSampler& light,
                                       const ProbePlanOptions& o) {
    AutoPlacementOptions options;
    options.count = o.auto_count;
    options.region = region_of(o, scene.scene());
    options.bounces = o.bounces;
    options.seed = o.seed;
    options.threads = o.threads;
    options.progress = o.progress;
    auto probes = auto_places(scene, light, options);
    if (!probes) return probes.error();
    return ProbePlan{*std::move(probes), std::nullopt, fmt::format("auto {}", o.auto_count)};
}

Result<ProbePlan> placed(const RayScene& scene, const EnvironmentSampler& light, const ProbePlanOptions& o) {
    const auto grid = grid_for(o, scene.scene());
    if (!grid) return grid.error();
    const float spacing = least_spacing(*grid);
    RelocationOptions relocate;
    relocate.nearest = o.nearest > 0 ? o.nearest : spacing > 0 ? 0.05f * spacing : 0.1f;
    relocate.farthest = o.farthest >= 0 ? o.farthest : spacing > 0 ? 0.45f * spacing : 0.5f;
    relocate.light = &light;
    relocate.threads = o.threads;
    relocate.progress = o.progress;
    auto probes = place_probes(scene, *grid ? places_of(**grid) : o.at, relocate);
    if (!probes) return probes.error();
    if (auto ok = fill_invalid(scene, *probes, o.threads); !ok) return ok.error();
    return ProbePlan{*std::move(probes), *grid,
                     !*grid          ? "at"
                     : wants_grid(o) ? "grid"
                                     : fmt::format("density {:g}", o.density)};
}

void set_boxes(const RayScene& scene, const ProbePlanOptions& o, std::vector<Probe>& probes) {
    if (o.walls && !o.proxy) set_proxies(scene, probes, o.threads);
    for (Probe& probe : probes) {
        if (o.proxy) probe.proxy = o.proxy;
        if (o.influence == ProbeInfluence::Shape::sphere)
            probe.influence = {o.influence, {}, o.radius, k_fade * o.radius};
        if (o.influence != ProbeInfluence::Shape::box || !probe.proxy) continue;
        const Vec3f size = probe.proxy->high - probe.proxy->low;
        probe.influence = {o.influence, *probe.proxy, 0, k_fade * std::min({size.x, size.y, size.z})};
    }
}

}  // namespace

Result<ProbePlan> plan_probes(const RayScene& scene, const EnvironmentSampler& light, const ProbePlanOptions& options) {
    if (auto ok = check(options); !ok) return ok.error();
    auto plan = options.auto_count != 0 ? placed_automatically(scene, light, options) : placed(scene, light, options);
    if (!plan) return plan.error();
    set_boxes(scene, options, plan->probes);
    return plan;
}

}  // namespace domelight
