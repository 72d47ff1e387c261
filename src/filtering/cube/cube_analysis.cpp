#include "filtering/cube/cube_analysis.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include "base/sort.h"
#include "filtering/cube/cube_nodes.h"
#include "filtering/harmonic/scatter_analysis.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace domelight {
namespace {

/// Cubes of this size and smaller are filtered many times a second, where a scene's own light is baked: time is saved
/// that costs larger ones little.
constexpr int k_small = 64;

/// Enough nodes that a function of this band limit is integrated over a texel's width. In a small cube half as many:
/// the highest degrees are integrated with an error of a few per cent then, but a lobe keeps next to nothing of them
/// (RMSE at most 1.3e-4 for roughness 0.25 and five photographs).
int nodes_a_cell(int size, int band_limit) {
    const double per_degree = size <= k_small ? 0.45 : 0.75;
    return std::clamp(2 + int(per_degree * band_limit / size), 2, 10);
}

/// Spreads the patches of one face.
void scatter_face(const BorderedCube& cube, int face, std::span<const AxisNode> axis, const simd::TapTable& table,
                  SphereGrid& grid) {
    const int count = int(axis.size());
    std::vector<double> x(count), y(count), z(count);
    std::vector<float> rgb(3 * std::size_t(count));
    const simd::GridView view = grid.view();
    for (const AxisNode& down : axis) {
        for (int i = 0; i < count; ++i) {
            const AxisNode& right = axis[i];
            const Vec3d d = cube_direction(face, {0.5 * (right.at + 1), 0.5 * (down.at + 1)});
            x[i] = d.x, y[i] = d.y, z[i] = d.z;
            // A face at distance 1: dω = ds dt / (1 + s^2 + t^2)^(3/2).
            const double r2 = 1 + right.at * right.at + down.at * down.at,
                         weight = right.weight * down.weight / (r2 * std::sqrt(r2));
            const float *a = cube.texel(face, right.cell, down.cell), *b = cube.texel(face, right.cell, down.cell + 1);
            for (int c = 0; c < 3; ++c) {
                const double top = a[c] + right.fraction * (a[c + 3] - double(a[c])),
                             bottom = b[c] + right.fraction * (b[c + 3] - double(b[c]));
                rgb[3 * i + c] = float(weight * (top + down.fraction * (bottom - top)));
            }
        }
        simd::scatter_directions(view, grid.ring(0), table, x.data(), y.data(), z.data(), count, rgb.data());
    }
}

}  // namespace

Spectrum analyse_cube(const BorderedCube& cube, int band_limit, int threads) {
    ScatterAnalysis analysis(grid_transform(band_limit));
    const RingGrid grid = analysis.grid();
    const auto axis = axis_nodes(cube.size(), nodes_a_cell(cube.size(), band_limit));
    // Faces overlap on the rings, so each has its own grid, unless that would take too much memory, or longer than what
    // it saves. This does not depend on the number of threads.
    const bool small = cube.size() <= k_small, large = std::int64_t(grid.rings) * grid.width >= (4 << 20);
    const int grid_count = small || large ? 1 : 6;
    std::vector<SphereGrid> grids;
    for (int g = 0; g < grid_count; ++g) grids.emplace_back(grid);
    parallel_for(grid_count, threads, [&](int g) {
        for (int face = g; face < 6; face += grid_count) scatter_face(cube, face, axis, analysis.table(), grids[g]);
    });
    return analysis.finish(grids, threads);
}

PointLights bright_points(const BorderedCube& cube, const Vec3d& mean, int band_limit, double least_share,
                          std::size_t most) {
    const int n = cube.size();
    struct Texel {
        double power;
        int face, x, y;
    };
    // This includes border texels, which represent the light of the neighbouring face.
    std::vector<Texel> texels;
    const double of_mean = std::max({mean.x, mean.y, mean.z}), least = least_share * 4 * k_pi * of_mean;
    for (int f = 0; f < 6; ++f)
        for (int y = -1; y <= n; ++y)
            for (int x = -1; x <= n; ++x) {
                const float* p = cube.texel(f, x, y);
                const float largest = std::max({p[0], p[1], p[2]});
                if (largest <= k_least_contrast * of_mean) continue;
                if (largest * 4.0 / (double(n) * n) <= least) continue;  // no texel is larger than 4 / n^2
                const double power = largest * cube_solid_angle(std::clamp(x, 0, n - 1), std::clamp(y, 0, n - 1), n);
                if (power > least) texels.push_back({power, f, x, y});
            }
    sort_stably(texels, [](const Texel& a, const Texel& b) { return a.power > b.power; });
    if (texels.size() > most) texels.resize(most);
    const auto axis = axis_nodes(n, nodes_a_cell(n, band_limit));
    const int count = int(axis.size()), per_cell = count / (n + 1);
    PointLights points;
    std::unordered_map<std::int64_t, int> places;  // of the nodes of a face: neighbouring texels share them
    for (const Texel& t : texels) {
        if (points.count() >= k_most_patches * per_cell * per_cell) break;
        const float* value = cube.texel(t.face, t.x, t.y);
        // The tent spans the cells before and after the texel.
        for (int j = std::max(0, t.y * per_cell); j < std::min((t.y + 2) * per_cell, count); ++j)
            for (int i = std::max(0, t.x * per_cell); i < std::min((t.x + 2) * per_cell, count); ++i) {
                const auto tent = [](const AxisNode& node, int texel) {
                    return node.cell == texel ? 1 - node.fraction : node.fraction;
                };
                const double s = axis[i].at, v = axis[j].at, r2 = 1 + s * s + v * v;
                const double weight =
                    tent(axis[i], t.x) * tent(axis[j], t.y) * axis[i].weight * axis[j].weight / (r2 * std::sqrt(r2));
                const auto [place, added] =
                    places.try_emplace((std::int64_t(t.face) * count + j) * count + i, points.count());
                if (added)
                    points.add(cube_direction(t.face, {0.5 * (s + 1), 0.5 * (v + 1)}) / std::sqrt(r2), weight, value);
                else
                    points.brighten(place->second, weight, value);
            }
    }
    return points;
}

}  // namespace domelight
