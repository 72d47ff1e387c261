#include "filtering/cube/cube_to_rings.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// From one to the next by a quarter turn from +X towards +Z.
constexpr int k_sides[4] = {0, 4, 1, 5};
constexpr int k_top = 2, k_bottom = 3;
constexpr int k_taps = 8;
constexpr int k_side_channels = 12, k_pole_channels = 24;

/// The points along one coordinate of a grid that a light goes to, and its shares.
struct Taps {
    int first;
    double share[k_taps];
};

Taps taps_at(const simd::TapTable& table, double at) {
    const int before = int(std::floor(at));
    const double steps = (at - before) * simd::TapTable::k_steps;
    const int step = std::min(int(steps), simd::TapTable::k_steps - 1);
    const float* low = table.down.data() + std::size_t(step) * k_taps;
    Taps taps{before - (k_taps / 2 - 1), {}};
    for (int k = 0; k < k_taps; ++k) taps.share[k] = low[k] + (steps - step) * (double(low[k + k_taps]) - low[k]);
    return taps;
}

double row_of(const RingGrid& grid, double theta) {
    return theta * grid.rings / k_pi - 0.5;
}
double column_of(const RingGrid& grid, double phi) {
    return phi * grid.width / (2 * k_pi);
}
int wrapped(int column, int width) {
    return ((column % width) + width) % width;
}

/// The share of the sphere of a node at (s, t) on a face at distance 1: dω = ds dt / (1 + s^2 + t^2)^(3/2).
double solid_angle(const AxisNode& right, const AxisNode& down) {
    const double r2 = 1 + right.at * right.at + down.at * down.at;
    return right.weight * down.weight / (r2 * std::sqrt(r2));
}

/// Of each texel, counted from the border: the nodes in the cells before and after it.
std::span<const AxisNode> nodes_around(std::span<const AxisNode> axis, int texel, int size) {
    const int a_cell = int(axis.size()) / (size + 1), from = std::max(0, texel - 1), to = std::min(texel + 1, size + 1);
    return axis.subspan(std::size_t(from * a_cell), std::size_t((to - from) * a_cell));
}
/// Of a node's light, the part that is the texel's.
double share_of(const AxisNode& node, int texel) {
    return node.cell + 1 == texel ? 1 - node.fraction : node.fraction;
}

}  // namespace

CubeToRings::CubeToRings(int size, RingGrid grid, const simd::TapTable& table, int nodes) : size_(size), grid_(grid) {
    const auto axis = axis_nodes(size, nodes);
    prepare_sides(table, axis);
    prepare_poles(table, axis);
}

void CubeToRings::prepare_sides(const simd::TapTable& table, std::span<const AxisNode> axis) {
    // The rings that lights at the middle of the face's upper edge reach, and their mirror images.
    first_ring_ = int(std::floor(row_of(grid_, k_pi / 4))) - k_taps;
    ring_count_ = grid_.rings - 2 * first_ring_;
    const auto column_to_rings = [&](const AxisNode& right) {
        SparsePixels to_rings(ring_count_);
        const double side = std::sqrt(1 + right.at * right.at);
        for (int texel = 0; texel < size_ + 2; ++texel)
            for (const AxisNode& down : nodes_around(axis, texel, size_)) {
                const Taps taps = taps_at(table, row_of(grid_, std::atan2(side, -down.at)));
                const double weight = solid_angle(right, down) * share_of(down, texel);
                for (int k = 0; k < k_taps; ++k)
                    to_rings.add(taps.first + k - first_ring_, texel, weight * taps.share[k]);
            }
        to_rings.finish();
        return to_rings;
    };
    for (const AxisNode& right : axis) columns_.push_back({right.cell, float(right.fraction), column_to_rings(right)});

    const int reach = grid_.width / 8 + k_taps;
    first_column_ = -reach;
    to_columns_ = SparsePixels(2 * reach + 1);
    for (int i = 0; i < int(axis.size()); ++i) {
        // u runs against the azimuth.
        const Taps taps = taps_at(table, column_of(grid_, std::atan(-axis[i].at)));
        for (int k = 0; k < k_taps; ++k) to_columns_.add(taps.first + k - first_column_, i, taps.share[k]);
    }
    to_columns_.finish();
}

void CubeToRings::prepare_poles(const simd::TapTable& table, std::span<const AxisNode> axis) {
    struct Place {
        Taps rows, columns;
    };
    std::vector<Place> places;
    for (const AxisNode& down : axis)
        for (const AxisNode& right : axis) {
            const Vec3d d = cube_direction(k_top, {0.5 * (right.at + 1), 0.5 * (down.at + 1)});
            places.push_back({taps_at(table, row_of(grid_, std::atan2(std::hypot(d.x, d.z), d.y))),
                              taps_at(table, column_of(grid_, std::atan2(d.z, d.x)))});
        }
    const auto place_of = [&](const AxisNode& right, const AxisNode& down) -> const Place& {
        return places[std::size_t(&down - axis.data()) * axis.size() + std::size_t(&right - axis.data())];
    };
    const int quarter = grid_.width / 4;
    const auto spread = [&](const Place& place, int texel, double weight) {
        for (int j = 0; j < k_taps; ++j) {
            // A point beyond the pole is one of the ring on this side, half a turn away.
            const int row = place.rows.first + j, ring = row < 0 ? -1 - row : row, turn = row < 0 ? grid_.width / 2 : 0;
            for (int k = 0; k < k_taps; ++k) {
                const int column = wrapped(place.columns.first + k + turn, grid_.width);
                if (column >= quarter) continue;
                to_cap_.add(ring * quarter + column, texel, weight * place.rows.share[j] * place.columns.share[k]);
            }
        }
    };
    // The rings that lights at the face's corners reach.
    cap_rings_ = std::min(int(std::ceil(row_of(grid_, std::acos(1 / std::sqrt(3.0))))) + k_taps, grid_.rings);
    to_cap_ = SparsePixels(cap_rings_ * quarter);
    for (int y = 0; y < size_ + 2; ++y)
        for (int x = 0; x < size_ + 2; ++x)
            for (const AxisNode& down : nodes_around(axis, y, size_))
                for (const AxisNode& right : nodes_around(axis, x, size_))
                    spread(place_of(right, down), y * (size_ + 2) + x,
                           solid_angle(right, down) * share_of(down, y) * share_of(right, x));
    to_cap_.finish();
}

void CubeToRings::apply(const BorderedCube& cube, SphereGrid& out, int threads) const {
    add_sides(cube, out, threads);
    add_poles(cube, out, threads);
}

void CubeToRings::add_sides(const BorderedCube& cube, SphereGrid& out, int threads) const {
    const int bordered = size_ + 2, count = int(columns_.size());
    const std::ptrdiff_t ring_stride = std::ptrdiff_t(count) * k_side_channels;
    AlignedArray<float> rings(std::size_t(ring_count_) * std::size_t(ring_stride), false);
    parallel_ranges(count, 8, threads, [&](int begin, int end) {
        std::vector<float> texels(std::size_t(bordered) * k_side_channels);
        for (int i = begin; i < end; ++i) {
            const Column& column = columns_[std::size_t(i)];
            float* texel = texels.data();
            for (int y = -1; y <= size_; ++y)
                for (const int face : k_sides) {
                    const float* p = cube.texel(face, column.cell, y);
                    for (int c = 0; c < 3; ++c) *texel++ = p[c] + column.fraction * (p[c + 3] - p[c]);
                }
            column.to_rings.apply(texels.data(), k_side_channels, 0, ring_count_, rings.data() + i * k_side_channels,
                                  ring_stride);
        }
    });
    const int width = to_columns_.points();
    parallel_ranges(ring_count_, 8, threads, [&](int begin, int end) {
        std::vector<float> row(std::size_t(width) * k_side_channels);
        for (int ring = begin; ring < end; ++ring) {
            to_columns_.apply(rings.data() + ring * ring_stride, k_side_channels, 0, width, row.data(),
                              k_side_channels);
            float* to = out.ring(first_ring_ + ring);
            for (int side = 0; side < 4; ++side)
                for (int x = 0; x < width; ++x) {
                    const int column = wrapped(side * grid_.width / 4 + first_column_ + x, grid_.width);
                    for (int c = 0; c < 3; ++c)
                        to[4 * column + c] += row[std::size_t(x * k_side_channels + 3 * side + c)];
                }
        }
    });
}

void CubeToRings::add_poles(const BorderedCube& cube, SphereGrid& out, int threads) const {
    const int bordered = size_ + 2, quarter = grid_.width / 4;
    // Channels: RGB of four turns of the upper face, and of four turns of the lower one's mirror image. A quarter turn takes
    // the direction (s, 1, t) to (-t, 1, s).
    AlignedArray<float> texels(std::size_t(bordered) * std::size_t(bordered) * k_pole_channels, false);
    for (int y = 0; y < bordered; ++y)
        for (int x = 0; x < bordered; ++x) {
            float* to = texels.data() + (std::size_t(y) * std::size_t(bordered) + std::size_t(x)) * k_pole_channels;
            int column = x, row = y;
            for (int turn = 0; turn < 4; ++turn, to += 3) {
                std::copy_n(cube.texel(k_top, column - 1, row - 1), 3, to);
                std::copy_n(cube.texel(k_bottom, column - 1, bordered - 2 - row), 3, to + 12);
                const int turned = bordered - 1 - row;
                row = column, column = turned;
            }
        }
    parallel_ranges(cap_rings_, 4, threads, [&](int begin, int end) {
        std::vector<float> row(std::size_t(quarter) * k_pole_channels);
        for (int ring = begin; ring < end; ++ring) {
            to_cap_.apply(texels.data(), k_pole_channels, ring * quarter, (ring + 1) * quarter, row.data(),
                          k_pole_channels);
            for (int turn = 0; turn < 4; ++turn) {
                float *north = out.ring(ring) + 4 * turn * quarter,
                      *south = out.ring(grid_.rings - 1 - ring) + 4 * turn * quarter;
                for (int x = 0; x < quarter; ++x)
                    for (int c = 0; c < 3; ++c) {
                        const float* from = row.data() + x * k_pole_channels + 3 * turn + c;
                        north[4 * x + c] += from[0];
                        south[4 * x + c] += from[12];
                    }
            }
        }
    });
}

}  // namespace domelight
