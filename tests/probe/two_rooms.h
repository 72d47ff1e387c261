#pragma once
// Two rooms with a closed wall between them, and probes in both whose light is known: 1 in the one room, 0 in the other.

#include "domelight/probe/probe_set.h"
#include "domelight/projection/projection.h"

#include "probe/cube_of.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace domelight::test {

/// The distance from a point in a box to its walls.
inline double distance_in_box(const ProbeBox& box, const Vec3f& from, const Vec3d& direction) {
    double t = 1e30;
    const auto leave = [&](double at, double along, double low, double high) {
        if (along != 0) t = std::min(t, ((along > 0 ? high : low) - at) / along);
    };
    leave(from.x, direction.x, box.low.x, box.high.x);
    leave(from.y, direction.y, box.low.y, box.high.y);
    leave(from.z, direction.z, box.low.z, box.high.z);
    return t;
}

struct TwoRooms {
    float thickness = 0.1f;  ///< of the wall at x = 0
    int distance_size = 16;
    ProbeBox lit() const { return {{-4, 0, -3}, {-thickness / 2, 3, 3}}; }
    ProbeBox dark() const { return {{thickness / 2, 0, -3}, {4, 3, 3}}; }

    /// The moments of a texel, averaged over its area.
    Cubemap distances(const ProbeBox& room, const Vec3f& from) const {
        const int n = distance_size, sub = 4;
        Cubemap cube(n, 2);
        for (int f = 0; f < 6; ++f)
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) {
                    double mean = 0, square = 0;
                    for (int k = 0; k < sub * sub; ++k) {
                        const double u = (x + (k % sub + 0.5) / sub) / n, v = (y + (k / sub + 0.5) / sub) / n;
                        const double d = distance_in_box(room, from, normalize(cube_direction(f, {u, v})));
                        mean += d, square += d * d;
                    }
                    float* texel = cube.face(f).at(x, y);
                    texel[0] = float(mean / (sub * sub)), texel[1] = float(square / (sub * sub));
                }
        return cube;
    }

    ProbeMaps maps(const Vec3f& at) const {
        const bool is_lit = at.x < 0;
        const auto light = [&](const Vec3d& d, float* p) {
            p[0] = p[1] = p[2] = is_lit ? float(1 + 0.3 * d.y + 0.1 * double(at.x) * d.z) : 0.f;
        };
        ProbeMaps maps;
        maps.specular = {cube_of(8, 3, light), cube_of(4, 3, light)};
        maps.irradiance_over_pi = cube_of(4, 3, light);
        if (is_lit) maps.harmonics[0] = Vec3d{1, 1, 1} * std::sqrt(4 * k_pi);
        maps.distance = distances(is_lit ? lit() : dark(), at);
        return maps;
    }

    /// Probes in a grid, 1 m apart, at x = -3.5, -2.5 ... 3.5; or, without a grid, at the same places moved a little.
    Result<ProbeSet> set(bool with_grid = true) const {
        const ProbeGrid grid{{-3.5f, 0.5f, -2.5f}, {1, 1, 1}, 8, 3, 6};
        std::vector<Probe> probes;
        std::vector<ProbeMaps> all;
        for (int i = 0; i < grid.count(); ++i) {
            Probe probe;
            probe.place = probe.position = grid.place(i);
            if (!with_grid)
                probe.position += Vec3f{0.1f * std::sin(7.f * i), 0.1f * std::sin(5.f * i), 0.1f * std::sin(3.f * i)};
            probe.proxy = probe.position.x < 0 ? lit() : dark();
            probes.push_back(probe);
            all.push_back(maps(probe.position));
        }
        return ProbeSet::from_maps(std::move(probes), with_grid ? std::optional(grid) : std::nullopt, {0, 1}, all);
    }
};

}  // namespace domelight::test
