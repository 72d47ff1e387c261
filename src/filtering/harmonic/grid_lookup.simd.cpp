#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filtering/harmonic/grid_lookup.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "base/float64-inl.h"
#include <hwy/contrib/math/math-inl.h>
#include "filtering/harmonic/grid_lookup.h"
#include <algorithm>
#include <cmath>
#include <numbers>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// atan2 in double, to about 1e-15: the arctangent of the smaller over the larger, extended by symmetry.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V arc_tangent2(D d, V y, V x) {
    const V ax = hn::Abs(x), ay = hn::Abs(y), big = hn::Max(ax, ay), small = hn::Min(ax, ay);
    const V safe = hn::Max(big, hn::Set(d, 1e-300));
    V a = hn::Atan(d, hn::Div(small, safe));
    a = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(hn::Set(d, std::numbers::pi / 2), a), a);
    a = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, std::numbers::pi), a), a);
    return hn::IfThenElse(hn::Lt(y, hn::Zero(d)), hn::Neg(a), a);
}

constexpr int k_block = 64;

/// Grid coordinates of directions: column in [0, width], row in [-1/2, rings - 1/2].
void grid_coordinates(const GridView& grid, const double* x, const double* y, const double* z, int count,
                      double* column, double* row) {
    const hn::ScalableTag<double> d;
    const int lanes = int(hn::Lanes(d));
    const auto per_column = hn::Set(d, grid.width / (2 * std::numbers::pi)),
               per_row = hn::Set(d, grid.rings / std::numbers::pi);
    for (int i = 0; i < count; i += lanes) {
        const auto vx = hn::LoadU(d, x + i), vy = hn::LoadU(d, y + i), vz = hn::LoadU(d, z + i);
        auto phi = arc_tangent2(d, vz, vx);
        phi = hn::IfThenElse(hn::Lt(phi, hn::Zero(d)), hn::Add(phi, hn::Set(d, 2 * std::numbers::pi)), phi);
        const auto theta = arc_tangent2(d, hn::Sqrt(hn::MulAdd(vx, vx, hn::Mul(vz, vz))), vy);
        hn::StoreU(hn::Mul(phi, per_column), d, column + i);
        hn::StoreU(hn::MulSub(theta, per_row, hn::Set(d, 0.5)), d, row + i);
    }
}

constexpr int k_taps = 8, k_quads = 4 * k_taps;
using D = hn::CappedTag<float, 16>;

/// Where a direction falls between the grid's points, and the weights there.
struct Place {
    HWY_INLINE Place(const GridView& grid, const TapTable& table, double column, double row) {
        const int c0 = int(column), r0 = int(std::floor(row));
        this->column = c0;
        const double fc = (column - c0) * TapTable::k_steps, fr = (row - r0) * TapTable::k_steps;
        const int ic = std::min(int(fc), TapTable::k_steps - 1), ir = std::min(int(fr), TapTable::k_steps - 1);
        offset = (r0 - (k_taps / 2 - 1)) * grid.stride + (c0 - (k_taps / 2 - 1)) * 4;
        across = table.across.data() + std::size_t(ic) * k_quads;
        t = float(fc - ic);
        const float* w = table.down.data() + std::size_t(ir) * k_taps;
        const float tr = float(fr - ir);
        const hn::CappedTag<float, k_taps> d;
        for (int k = 0; k < k_taps; k += int(hn::Lanes(d))) {
            const auto low = hn::LoadU(d, w + k), high = hn::LoadU(d, w + k + k_taps);
            hn::Store(hn::Add(low, hn::Mul(hn::Set(d, tr), hn::Sub(high, low))), d, down + k);
        }
    }
    /// Vector v of the weights along a row.
    HWY_INLINE hn::Vec<D> across_weights(int v) const {
        const D d;
        const float* w = across + v * int(hn::Lanes(d));
        const auto low = hn::LoadU(d, w), high = hn::LoadU(d, w + k_quads);
        return hn::MulAdd(hn::Set(d, t), hn::Sub(high, low), low);
    }
    std::ptrdiff_t offset;
    int column;
    const float* across;
    float t;
    alignas(64) float down[k_taps];
};

HWY_INLINE void lookup_one(const GridView& grid, const Place& place, float* rgb) {
    const D d;
    constexpr int lanes = int(hn::MaxLanes(d)), vectors = k_quads / lanes;
    hn::Vec<D> sum[vectors];
    const float* from = grid.rgbx + place.offset;
    for (int v = 0; v < vectors; ++v) sum[v] = hn::Mul(hn::LoadU(d, from + v * lanes), hn::Set(d, place.down[0]));
    for (int k = 1; k < k_taps; ++k) {
        from += grid.stride;
        const auto weight = hn::Set(d, place.down[k]);
        for (int v = 0; v < vectors; ++v) sum[v] = hn::MulAdd(hn::LoadU(d, from + v * lanes), weight, sum[v]);
    }
    // First the vectors with the same channels are added: all of them, unless a vector is shorter than a texel (as on
    // the portable target).
    constexpr int kinds = lanes < 4 ? 4 / lanes : 1;
    alignas(64) float parts[lanes * kinds];
    for (int k = 0; k < kinds; ++k) {
        auto total = hn::Mul(place.across_weights(k), sum[k]);
        for (int v = k + kinds; v < vectors; v += kinds) total = hn::MulAdd(place.across_weights(v), sum[v], total);
        hn::Store(total, d, parts + k * lanes);
    }
    for (int c = 0; c < 3; ++c) {
        float value = parts[c];
        for (int p = 4; p < lanes; p += 4) value += parts[p + c];
        rgb[c] = value;
    }
}

HWY_INLINE void scatter_one(const GridView& grid, float* rgbx, const Place& place, const float* rgb) {
    const D d;
    constexpr int lanes = int(hn::MaxLanes(d)), vectors = k_quads / lanes;
    alignas(16) const float rgbx_value[4] = {rgb[0], rgb[1], rgb[2], 0};
    hn::Vec<D> row[vectors];
    for (int v = 0; v < vectors; ++v) {
        // A texel in each quarter of the vector, or the part of it that a shorter vector holds.
        const auto value = lanes >= 4 ? hn::LoadDup128(d, rgbx_value) : hn::LoadU(d, rgbx_value + v * lanes % 4);
        row[v] = hn::Mul(place.across_weights(v), value);
    }
    float* to = rgbx + place.offset;
    for (int k = 0; k < k_taps; ++k, to += grid.stride) {
        const auto weight = hn::Set(d, place.down[k]);
        for (int v = 0; v < vectors; ++v)
            hn::StoreU(hn::MulAdd(row[v], weight, hn::LoadU(d, to + v * lanes)), d, to + v * lanes);
    }
}

/// Calls use(i, place) for each direction.
template <typename Use>
HWY_INLINE void for_each_place(const GridView& grid, const TapTable& table, const double* x, const double* y,
                               const double* z, int count, const Use& use) {
    double column[k_block], row[k_block], bx[k_block], by[k_block], bz[k_block];
    for (int i = 0; i < count; i += k_block) {
        const int n = std::min(k_block, count - i);
        const double *px = x + i, *py = y + i, *pz = z + i;
        if (n < k_block) {  // whole vectors only: unused lanes look along +X
            for (int k = 0; k < k_block; ++k) {
                bx[k] = k < n ? px[k] : 1;
                by[k] = k < n ? py[k] : 0;
                bz[k] = k < n ? pz[k] : 0;
            }
            px = bx, py = by, pz = bz;
        }
        constexpr int k_most_lanes = 8;
        grid_coordinates(grid, px, py, pz, (n + k_most_lanes - 1) / k_most_lanes * k_most_lanes, column, row);
        for (int k = 0; k < n; ++k) {
            Place place(grid, table, column[k], row[k]);
            use(i + k, place);
        }
    }
}

void lookup_directions(const GridView& grid, const TapTable& table, const double* x, const double* y, const double* z,
                       int count, float* out) {
    for_each_place(grid, table, x, y, z, count,
                   [&](int i, const Place& place) HWY_ATTR { lookup_one(grid, place, out + 3 * std::size_t(i)); });
}

void lookup_quarter_turns(const GridView& grid, const TapTable& table, const double* x, const double* y,
                          const double* z, int count, float* const (&out)[4]) {
    const std::ptrdiff_t quarter = grid.width,
                         row = 4 * std::ptrdiff_t(grid.width);  // floats of a quarter of a ring, and of all
    for_each_place(grid, table, x, y, z, count, [&](int i, Place& place) HWY_ATTR {
        for (int k = 0; k < 4; ++k) {
            lookup_one(grid, place, out[k] + 3 * std::size_t(i));
            place.offset += quarter;
            place.column += grid.width / 4;
            if (place.column >= grid.width) place.offset -= row, place.column -= grid.width;
        }
    });
}

void scatter_directions(const GridView& grid, float* rgbx, const TapTable& table, const double* x, const double* y,
                        const double* z, int count, const float* rgb) {
    for_each_place(grid, table, x, y, z, count, [&](int i, const Place& place) HWY_ATTR {
        scatter_one(grid, rgbx, place, rgb + 3 * std::size_t(i));
    });
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(lookup_directions);
HWY_EXPORT(lookup_quarter_turns);
HWY_EXPORT(scatter_directions);

TapTable::TapTable(const InterpolationTaps& taps) : across((k_steps + 1) * 32), down((k_steps + 1) * 8) {
    double w[8];
    for (int i = 0; i <= k_steps; ++i) {
        taps.weights(double(i) / k_steps, w);
        for (int k = 0; k < 8; ++k) {
            down[i * 8 + k] = float(w[k]);
            for (int c = 0; c < 4; ++c) across[i * 32 + k * 4 + c] = float(w[k]);
        }
    }
}

void lookup_directions(const GridView& grid, const TapTable& table, const double* x, const double* y, const double* z,
                       int count, float* out) {
    HWY_DYNAMIC_DISPATCH(lookup_directions)(grid, table, x, y, z, count, out);
}
void lookup_quarter_turns(const GridView& grid, const TapTable& table, const double* x, const double* y,
                          const double* z, int count, float* const (&out)[4]) {
    HWY_DYNAMIC_DISPATCH(lookup_quarter_turns)(grid, table, x, y, z, count, out);
}
void scatter_directions(const GridView& grid, float* rgbx, const TapTable& table, const double* x, const double* y,
                        const double* z, int count, const float* rgb) {
    HWY_DYNAMIC_DISPATCH(scatter_directions)(grid, rgbx, table, x, y, z, count, rgb);
}

}  // namespace domelight::simd
#endif
