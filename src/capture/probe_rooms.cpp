#include "domelight/capture/probe_rooms.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include "capture/surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace domelight {
namespace {

/// Rays a side: so many rows of so many.
constexpr int k_rows = 16;
/// A side has a wall where at least this part of its rays meet surfaces that face the point.
constexpr double k_least_walls = 0.1;

std::optional<float> median(std::vector<float>& values) {
    if (values.empty()) return std::nullopt;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The distance of the wall on one side of a point, along the axis of that face of the cube; none where it is open.
std::optional<float> wall_distance(const RayScene& scene, const Vec3f& from, int face) {
    std::vector<float> walls, all;
    bool open = false;
    // Most rays lie near the middle, where the end of a long corridor is.
    const auto spread = [](int i) {
        const double t = 2 * (i + 0.5) / k_rows - 1;
        return 0.5 + 0.25 * t * t * t;
    };
    const Vec3f axis(cube_direction(face, {0.5, 0.5}));
    for (int j = 0; j < k_rows; ++j)
        for (int i = 0; i < k_rows; ++i) {
            // The component along the axis is 1, so the distance along the axis is that along the ray over its length.
            const Vec3f direction(cube_direction(face, {spread(i), spread(j)}));
            const SurfaceAlong found = surface_along(scene, from, normalize(direction));
            open |= std::isinf(found.distance);
            if (std::isinf(found.distance)) continue;
            all.push_back(found.distance / length(direction));
            // The side walls of a corridor, and its floor, do not face along it.
            if (std::abs(dot(found.normal, axis)) > 0.5f) walls.push_back(all.back());
        }
    if (double(walls.size()) >= k_least_walls * k_rows * k_rows) return median(walls);
    return open ? std::nullopt : median(all);
}

}  // namespace

std::optional<ProbeBox> room_around(const RayScene& scene, const Vec3f& point) {
    const Scene::Box bounds = scene.scene().bounds();
    const float p[3] = {point.x, point.y, point.z}, low[3] = {bounds.low.x, bounds.low.y, bounds.low.z},
                high[3] = {bounds.high.x, bounds.high.y, bounds.high.z};
    std::array<float, 6> side{};
    int walls = 0;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const auto distance = wall_distance(scene, point, face);
        walls += distance.has_value();
        side[std::size_t(face)] = face % 2 == 0 ? (distance ? p[axis] + *distance : std::max(high[axis], p[axis]))
                                                : (distance ? p[axis] - *distance : std::min(low[axis], p[axis]));
    }
    if (walls < 3) return std::nullopt;
    return ProbeBox{{side[1], side[3], side[5]}, {side[0], side[2], side[4]}};
}

void set_proxies(const RayScene& scene, std::span<Probe> probes, int threads) {
    parallel_for(int(probes.size()), threads, [&](int i) {
        Probe& probe = probes[std::size_t(i)];
        probe.proxy = room_around(scene, probe.position);
    });
    // The light of another probe comes with that probe's walls.
    for (Probe& probe : probes)
        if (probe.filled_from >= 0) probe.proxy = probes[std::size_t(probe.filled_from)].proxy;
}

}  // namespace domelight
