#include "filtering/harmonic/sphere_grid.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include "base/interpolation_taps.h"
#include "base/mutex.h"
#include "filtering/harmonic/row_kernels.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <span>

namespace domelight {
namespace {

/// The error that ResidualLights may leave out, as a part of the least value.
constexpr double k_tolerance = 1e-5;

constexpr int k_all_faces[6] = {0, 1, 2, 3, 4, 5};

/// Sets negative values of a row to 0; returns how many texels had one.
int clamp_texels(float* rgb, int width) {
    int count = 0;
    for (int x = 0; x < width; ++x) {
        float* p = rgb + 3 * std::ptrdiff_t(x);
        count += p[0] < 0 || p[1] < 0 || p[2] < 0;
    }
    simd::clamp_negative(rgb, 3 * width);
    return count;
}

/// Looks up rows of texels, adds what the expansion lacks, and clamps.
class RowLookup {
  public:
    RowLookup(const SphereGrid& grid, const LookupOptions& options)
        : view_(grid.view()), table_(lookup_table(options.band)), options_(options) {}

    /// A row of texels at directions in the world; returns how many had a negative value.
    int row(std::span<const Vec3d> directions, float* rgb) const {
        Row r(directions, options_.world_to_source);
        simd::lookup_directions(view_, *table_, r.x(), r.y(), r.z(), r.count, rgb);
        return complete(r, rgb);
    }
    /// The same for a row and its turns by one, two and three quarters about the source's polar axis.
    int quarter_turns(std::span<const Vec3d> directions, float* const (&rgb)[4]) const {
        Row r(directions, options_.world_to_source);
        simd::lookup_quarter_turns(view_, *table_, r.x(), r.y(), r.z(), r.count, rgb);
        int clamped = 0;
        for (int k = 0; k < 4; ++k) {
            clamped += complete(r, rgb[k]);
            r.turn();
        }
        return clamped;
    }

  private:
    /// Directions in the source's frame.
    struct Row {
        Row(std::span<const Vec3d> directions, const Mat3& world_to_source)
            : count(int(directions.size())), values(3 * directions.size()) {
            for (int i = 0; i < count; ++i) {
                const Vec3d d = world_to_source * directions[i];
                x()[i] = d.x, y()[i] = d.y, z()[i] = d.z;
            }
        }
        double* x() { return values.data(); }
        double* y() { return x() + count; }
        double* z() { return y() + count; }
        void turn() {
            for (int i = 0; i < count; ++i) {
                std::swap(x()[i], z()[i]);
                x()[i] = -x()[i];
            }
        }
        int count;
        std::vector<double> values;
    };

    int complete(Row& r, float* rgb) const {
        if (options_.residual || options_.lights) {
            const int n = r.count;
            std::vector<float> unit(3 * std::size_t(n));
            float *x = unit.data(), *y = x + n, *z = y + n;
            for (int i = 0; i < n; ++i) {
                const double dx = r.x()[i], dy = r.y()[i], dz = r.z()[i],
                             scale = 1 / std::sqrt(dx * dx + dy * dy + dz * dz);
                x[i] = float(dx * scale), y[i] = float(dy * scale), z[i] = float(dz * scale);
            }
            if (options_.residual)
                simd::add_residual_sums(options_.residual->view(), options_.residual->table(), x, y, z, n, rgb);
            if (const auto* lights = options_.lights)
                simd::add_direct_lights(lights->nodes.data(), int(lights->nodes.size()), lights->points.view(),
                                        options_.kernel, x, y, z, n, rgb);
        }
        return clamp_texels(rgb, r.count);
    }

    simd::GridView view_;
    std::shared_ptr<const simd::TapTable> table_;
    const LookupOptions& options_;
};

/// Calls row(y), which returns a count, for each of `rows`; returns the sum.
template <typename Row>
std::int64_t for_rows(int rows, int threads, const Row& row) {
    std::vector<int> counts(rows);
    parallel_ranges(rows, 4, threads, [&](int begin, int end) {
        for (int y = begin; y < end; ++y) counts[y] = row(y);
    });
    return std::accumulate(counts.begin(), counts.end(), std::int64_t(0));
}

}  // namespace

SphereGrid::SphereGrid(RingGrid grid, bool zeroed)
    : grid_(grid),
      stride_(4 * (std::ptrdiff_t(grid.width) + 3 * k_pad)),
      data_(std::size_t(grid.rings + 2 * k_pad) * stride_, zeroed) {}

void SphereGrid::wrap() {
    const int w = grid_.width, h = grid_.rings;
    for (int k = 0; k < h; ++k) {
        float* row = ring(k);
        std::copy_n(row + 4 * std::ptrdiff_t(w - k_pad), 4 * k_pad, row - 4 * k_pad);
        std::copy_n(row, 8 * k_pad, row + 4 * std::ptrdiff_t(w));
    }
    // Beyond a pole lies the mirror ring, half a turn away.
    const auto beyond = [&](int to, int from) {
        const float* source = ring(from);
        float* row = ring(to);
        for (int i = -k_pad; i < w + 2 * k_pad; ++i)
            std::copy_n(source + 4 * ((i + w + w / 2) % w), 4, row + 4 * std::ptrdiff_t(i));
    };
    for (int k = 0; k < k_pad; ++k) {
        beyond(-1 - k, k);
        beyond(h + k, h - 1 - k);
    }
}

std::shared_ptr<const simd::TapTable> lookup_table(double band) {
    constexpr std::size_t most = 16;
    static Mutex mutex;
    static std::deque<std::pair<double, std::shared_ptr<const simd::TapTable>>> tables;
    const Lock lock(mutex);
    for (const auto& [of, table] : tables)
        if (of == band) return table;
    if (tables.size() == most) tables.pop_front();
    tables.emplace_back(band, std::make_shared<simd::TapTable>(InterpolationTaps(8, band, k_filtered_decay)));
    return tables.back().second;
}

ResidualLights::ResidualLights(const LightGroups& groups, const ResidualKernel& kernel, const Vec3d& least)
    : groups_(groups), kernel_(kernel) {
    // If each light may leave the same error, all together leave at most k_tolerance of the least value.
    for (int g = 0; g < groups.count(); ++g) {
        const Vec3d& most = groups.most[g];
        const double share = std::max({most.x / least.x, most.y / least.y, most.z / least.z, 1e-30}),
                     error = k_tolerance / (groups.used * share), ring = kernel.ring_limit(error),
                     chord = kernel.axis_limit(error), radius = groups.radius[g];
        ring_limit_.push_back(ring > 0 ? float(ring + radius) : -1.f);
        const double widest = std::min(chord + radius, 2.0);
        axis_limit_.push_back(chord > 0 ? float(1 - 0.5 * widest * widest) : 2.f);
    }
}

simd::ResidualGroups ResidualLights::view() const {
    return {groups_.x.data(),   groups_.y.data(), groups_.z.data(),     ring_limit_.data(),
            axis_limit_.data(), groups_.count(),  groups_.lights.view()};
}

Cubemap grid_to_cube(const SphereGrid& grid, int size, const LookupOptions& options, std::int64_t& clamped) {
    Cubemap cube(ImageF::uninitialized(size, 6 * size, 3));
    const RowLookup lookup(grid, options);
    const auto directions = [size](int face, int y) {
        std::vector<Vec3d> row(size);
        for (int x = 0; x < size; ++x) row[x] = cube_direction(face, {(x + 0.5) / size, (y + 0.5) / size});
        return row;
    };
    // If the source's pole is the world's, the side faces are rotations of one another: by +90 degrees from one to the
    // next, unless the source is mirrored.
    constexpr int sides[4] = {0, 4, 1, 5}, poles[2] = {2, 3};
    const auto& m = options.world_to_source.row;
    const bool turns = m[1] == Vec3d{0, 1, 0} && cross(m[2], m[0]).y > 0 && grid.grid().width % 4 == 0;
    if (turns)
        clamped += for_rows(size, options.threads, [&](int y) {
            auto row = directions(sides[0], y);
            float* out[4];
            for (int k = 0; k < 4; ++k) out[k] = cube.face(sides[k]).row(y);
            return lookup.quarter_turns(row, out);
        });
    const std::span<const int> one_by_one = turns ? std::span<const int>(poles) : std::span<const int>(k_all_faces);
    clamped += for_rows(int(one_by_one.size()) * size, options.threads, [&](int task) {
        const int face = one_by_one[task / size], y = task % size;
        auto row = directions(face, y);
        return lookup.row(row, cube.face(face).row(y));
    });
    return cube;
}

ImageF grid_to_latlong(const SphereGrid& grid, int height, const LookupOptions& options, std::int64_t& clamped) {
    const int width = 2 * height;
    ImageF image = ImageF::uninitialized(width, height, 3);
    const RowLookup lookup(grid, options);
    std::vector<Vec3d> equator(width);
    for (int x = 0; x < width; ++x) equator[x] = latlong_direction({(x + 0.5) / width, 0.5});
    clamped += for_rows(height, options.threads, [&](int y) {
        const double theta = k_pi * (y + 0.5) / height, s = std::sin(theta);
        std::vector<Vec3d> row(width);
        for (int x = 0; x < width; ++x) row[x] = {s * equator[x].x, std::cos(theta), s * equator[x].z};
        return lookup.row(row, image.row(y));
    });
    return image;
}

ImageF grid_at_directions(const SphereGrid& grid, std::span<const Vec3d> directions, const LookupOptions& options,
                          std::int64_t& clamped) {
    constexpr int k_piece = 256;
    const int count = int(directions.size());
    ImageF image = ImageF::uninitialized(count, 1, 3);
    const RowLookup lookup(grid, options);
    clamped += for_rows((count + k_piece - 1) / k_piece, options.threads, [&](int piece) {
        const int first = piece * k_piece;
        return lookup.row(directions.subspan(first, std::min(k_piece, count - first)), image.at(first, 0));
    });
    return image;
}

}  // namespace domelight
