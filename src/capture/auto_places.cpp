#include "domelight/base/parallel.h"
#include "domelight/base/random.h"
#include "domelight/capture/capture.h"
#include "domelight/capture/placement.h"
#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/projection/projection.h"

#include "base/field_place.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>

namespace domelight {
namespace {

/// The finest cells have 2^k_depth times smaller sides than the first ones.
constexpr int k_depth = 8;
constexpr int k_capture_size = 8, k_capture_samples = 32;
/// This part of the probes at most is placed before cells are divided.
constexpr double k_first_share = 0.34;

/// A place on the finest lattice.
using Key = std::array<int, 3>;

/// A probe at a corner of cells, and the light there.
struct Corner {
    Probe probe;
    std::array<Vec3f, 6> irradiance{};  ///< E / pi on surfaces that face along +X -X +Y -Y +Z -Z, mapped by c / (1 + c)
    std::vector<float> distances;       ///< of what the texels of the small capture show, rising
    /// The share of the directions in which there is a surface within `metres`.
    double surfaces_within(float metres) const {
        const auto end = std::ranges::upper_bound(distances, metres);
        return double(end - distances.begin()) / (6.0 * k_capture_size * k_capture_size);
    }
};

struct Cell {
    Key low;
    int side = 1;  ///< of the lattice
    double change = 0;
    /// The largest change is divided first; ties by the place, so that the order is the same each time.
    bool operator<(const Cell& b) const { return change != b.change ? change < b.change : low > b.low; }
};

std::array<Key, 8> corners_of(const Cell& cell) {
    std::array<Key, 8> keys;
    for (int i = 0; i < 8; ++i)
        keys[std::size_t(i)] = {cell.low[0] + (i & 1 ? cell.side : 0), cell.low[1] + (i & 2 ? cell.side : 0),
                                cell.low[2] + (i & 4 ? cell.side : 0)};
    return keys;
}

/// E / pi along the six axes, of the coefficients of a cube's radiance in nine harmonics; as a display shows them, so
/// that a difference counts by how visible it is.
std::array<Vec3f, 6> seen_irradiance(const Cubemap& cube) {
    std::vector<Vec3d> radiance(9);
    std::array<double, 9> basis{};
    const int n = cube.size();
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                sh_basis(normalize(cube_direction(f, {(x + 0.5) / n, (y + 0.5) / n})), 3, basis);
                const float* p = cube.face(f).at(x, y);
                const Vec3d power = Vec3d(Vec3f{p[0], p[1], p[2]}) * cube_solid_angle(x, y, n);
                for (std::size_t i = 0; i < 9; ++i) radiance[i] += power * basis[i];
            }
    const std::vector<Vec3d> irradiance = sh_irradiance_over_pi(radiance);
    std::array<Vec3f, 6> seen;
    for (int f = 0; f < 6; ++f) {
        const Vec3d e = sh_evaluate(irradiance, cube_direction(f, {0.5, 0.5}));
        const auto shown = [](double v) { return std::max(0.0, v) / (1 + std::max(0.0, v)); };
        seen[std::size_t(f)] = Vec3f(Vec3d{shown(e.x), shown(e.y), shown(e.z)});
    }
    return seen;
}

class AutoPlacer {
  public:
    AutoPlacer(const RayScene& scene, const EnvironmentSampler& light, const AutoPlacementOptions& options)
        : scene_(scene), light_(light), options_(options) {}

    Result<std::vector<Probe>> run() {
        choose_cells();
        std::vector<Cell> cells;
        for (int z = 0; z < counts_[2]; ++z)
            for (int y = 0; y < counts_[1]; ++y)
                for (int x = 0; x < counts_[0]; ++x) cells.push_back({{x * k_side, y * k_side, z * k_side}, k_side, 0});
        if (auto ok = add_corners(cells); !ok) return ok.error();
        for (const Cell& cell : cells) push(cell);
        while (!queue_.empty() && valid_ < options_.count) {
            const Cell cell = queue_.top();
            queue_.pop();
            if (!(cell.change > 0)) break;
            const std::vector<Cell> parts = eighths(cell);
            if (auto ok = add_corners(parts); !ok) return ok.error();
            for (const Cell& part : parts) push(part);
        }
        return result();
    }

  private:
    static constexpr int k_side = 1 << k_depth;

    /// About cubic cells, as many as leave most of the probes for the places where the light changes.
    void choose_cells() {
        const Vec3f extent = options_.region.high - options_.region.low;
        const double length[3] = {extent.x, extent.y, extent.z};
        const double longest = std::max({length[0], length[1], length[2]});
        const double most = std::max(8.0, k_first_share * options_.count);
        for (int along = 1;; ++along) {
            std::array<int, 3> counts{};
            double corners = 1;
            for (std::size_t i = 0; i < 3; ++i) {
                counts[i] = std::max(1, int(std::lround(along * length[i] / longest)));
                corners *= counts[i] + 1;
            }
            if (along > 1 && corners > most) return;
            counts_ = counts;
        }
    }

    /// The outermost places lie a quarter of a cell inside the region: on its sides there are walls.
    Vec3f place(const Key& key) const {
        const Vec3f& low = options_.region.low;
        const Vec3f extent = options_.region.high - low;
        const auto along = [&](std::size_t i, float start, float size) {
            const float cells = float(counts_[i]), at = float(key[i]) / float(k_side);
            return start + size * (0.25f + at) / (cells + 0.5f);
        };
        return {along(0, low.x, extent.x), along(1, low.y, extent.y), along(2, low.z, extent.z)};
    }

    /// The shortest side of a cell of that many steps of the lattice, metres.
    float metres(int side) const {
        const Vec3f a = place({0, 0, 0}), b = place({side, side, side});
        return std::min({b.x - a.x, b.y - a.y, b.z - a.z});
    }

    static std::vector<Cell> eighths(const Cell& cell) {
        std::vector<Cell> parts;
        if (cell.side == 1) return parts;
        for (const Key& low : corners_of({cell.low, cell.side / 2, 0})) parts.push_back({low, cell.side / 2, 0});
        return parts;
    }

    /// Places and judges those corners that are new.
    Result<void> add_corners(const std::vector<Cell>& cells) {
        std::vector<Key> keys;
        for (const Cell& cell : cells)
            for (const Key& key : corners_of(cell))
                if (!corners_.contains(key)) {
                    corners_[key] = {};
                    keys.push_back(key);
                }
        if (keys.empty()) return {};
        std::vector<Vec3f> places;
        for (const Key& key : keys) places.push_back(place(key));
        RelocationOptions relocate;
        relocate.nearest = std::max(1e-6f, 0.05f * metres(cells.front().side));
        relocate.farthest = 0.45f * metres(cells.front().side);
        relocate.light = &light_;
        relocate.threads = options_.threads;
        const auto probes = place_probes(scene_, places, relocate);
        if (!probes) return probes.error();
        for (std::size_t i = 0; i < keys.size(); ++i) corners_[keys[i]].probe = (*probes)[i];
        if (auto ok = judge(keys); !ok) return ok;
        if (options_.progress && !options_.progress("place", std::min(1.0, double(valid_) / options_.count)))
            return Error{"cancelled", "", ""};
        return {};
    }

    Result<void> judge(const std::vector<Key>& keys) {
        std::vector<Vec3f> positions;
        std::vector<int> numbers;
        std::vector<Corner*> captured;
        for (const Key& key : keys) {
            Corner& corner = corners_[key];
            if (!corner.probe.valid) continue;
            if (valid_ < options_.count) kept_.push_back(key);
            ++valid_;
            positions.push_back(corner.probe.position);
            numbers.push_back(made_++);
            captured.push_back(&corner);
        }
        CaptureOptions options;
        options.size = k_capture_size, options.samples = k_capture_samples, options.bounces = options_.bounces;
        options.seed = derive_key(options_.seed, 0x706c616365ull);
        options.threads = options_.threads;
        return capture(scene_, light_, positions, numbers, options, [&](int i, CapturedCube cube) -> Result<void> {
            Corner& corner = *captured[std::size_t(i)];
            corner.irradiance = seen_irradiance(cube.radiance);
            const auto depth = cube.depth.pixels(), coverage = cube.coverage.pixels();
            for (std::size_t t = 0; t < depth.size(); ++t)
                if (coverage[t] > 0.5f) corner.distances.push_back(depth[t]);
            std::ranges::sort(corner.distances);
            return {};
        });
    }

    void push(Cell cell) {
        if (cell.side == 1) return;
        cell.change = change_within(cell);
        queue_.push(cell);
    }

    /// The largest difference of the light between two corners in the open, times the side of the cell: what an
    /// interpolation can be wrong by, summed over the distance for which it is. Of cells that no surface is near, which
    /// could show it, a tenth counts.
    double change_within(const Cell& cell) const {
        std::vector<const Corner*> open;
        for (const Key& key : corners_of(cell))
            if (const Corner& corner = corners_.at(key); corner.probe.valid) open.push_back(&corner);
        double most = 0;
        for (std::size_t i = 0; i < open.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                for (std::size_t f = 0; f < 6; ++f) {
                    const Vec3f d = open[i]->irradiance[f] - open[j]->irradiance[f];
                    most = std::max({most, std::abs(double(d.x)), std::abs(double(d.y)), std::abs(double(d.z))});
                }
        double surfaces = 0;
        for (const Corner* corner : open) surfaces += corner->surfaces_within(metres(cell.side)) / double(open.size());
        return most * cell.side * (0.1 + 0.9 * surfaces);
    }

    Result<std::vector<Probe>> result() const {
        std::vector<Probe> probes;
        for (const Key& key : kept_) probes.push_back(corners_.at(key).probe);
        if (probes.empty())
            return Error{"no place lies in the open: all are inside bodies", field_place("region"),
                         "Name the box of the room."};
        return probes;
    }

    const RayScene& scene_;
    const EnvironmentSampler& light_;
    const AutoPlacementOptions& options_;
    std::array<int, 3> counts_{1, 1, 1};
    std::map<Key, Corner> corners_;
    std::vector<Key> kept_;  ///< the valid ones in the order in which they were placed
    std::priority_queue<Cell> queue_;
    int valid_ = 0, made_ = 0;
};

Result<void> check(const AutoPlacementOptions& o) {
    if (o.count < 8 || o.count > 1 << 20)
        return Error{fmt::format("{} is not from 8 to {}", o.count, 1 << 20), field_place("auto"),
                     "Fewer places are better chosen by hand: `at`."};
    if (o.bounces < 0 || o.bounces > 1000)
        return Error{fmt::format("{} is not from 0 to 1000", o.bounces), field_place("bounces"), ""};
    const Vec3f size = o.region.high - o.region.low;
    const float least = std::min({size.x, size.y, size.z}), most = std::max({size.x, size.y, size.z});
    if (!(least > 0) || !std::isfinite(most))
        return Error{fmt::format("is {} x {} x {} metres large", size.x, size.y, size.z), field_place("region"),
                     "It must have an extent on every axis."};
    return {};
}

}  // namespace

Result<std::vector<Probe>> auto_places(const RayScene& scene, const EnvironmentSampler& light,
                                       const AutoPlacementOptions& options) {
    if (auto ok = check(options); !ok) return ok.error();
    return AutoPlacer(scene, light, options).run();
}

}  // namespace domelight
