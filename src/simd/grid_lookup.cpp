#include "simd/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/grid_lookup.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>

#include "simd/grid_lookup.h"

#include <algorithm>
#include <cmath>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// atan2 in double, to about 1e-15: atan of the smaller over the larger, then unfolded.
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
void grid_coordinates(const GridView& grid, const double* x, const double* y, const double* z, int count, double* column, double* row) {
    const hn::ScalableTag<double> d;
    const int lanes = int(hn::Lanes(d));
    const auto per_column = hn::Set(d, grid.width / (2 * std::numbers::pi)), per_row = hn::Set(d, grid.rings / std::numbers::pi);
    for (int i = 0; i < count; i += lanes) {
        const auto vx = hn::LoadU(d, x + i), vy = hn::LoadU(d, y + i), vz = hn::LoadU(d, z + i);
        auto phi = arc_tangent2(d, vz, vx);
        phi = hn::IfThenElse(hn::Lt(phi, hn::Zero(d)), hn::Add(phi, hn::Set(d, 2 * std::numbers::pi)), phi);
        const auto theta = arc_tangent2(d, hn::Sqrt(hn::MulAdd(vx, vx, hn::Mul(vz, vz))), vy);
        hn::StoreU(hn::Mul(phi, per_column), d, column + i);
        hn::StoreU(hn::MulSub(theta, per_row, hn::Set(d, 0.5)), d, row + i);
    }
}

HWY_INLINE void lookup_one(const GridView& grid, const TapTable& table, double column, double row, float* rgb) {
    constexpr int taps = 8, quads = 4 * taps;
    const hn::CappedTag<float, 16> d;
    constexpr int lanes = int(hn::MaxLanes(d)), vectors = quads / lanes;

    const int c0 = int(column), r0 = int(std::floor(row));
    const double fc = (column - c0) * TapTable::k_steps, fr = (row - r0) * TapTable::k_steps;
    const int ic = std::min(int(fc), TapTable::k_steps - 1), ir = std::min(int(fr), TapTable::k_steps - 1);
    const float tc = float(fc - ic), tr = float(fr - ir);

    alignas(64) float down[taps];
    const float* w = table.down.data() + std::size_t(ir) * taps;
    for (int k = 0; k < taps; ++k) down[k] = w[k] + tr * (w[k + taps] - w[k]);

    hn::Vec<decltype(d)> sum[vectors];
    const float* from = grid.rgbx + (r0 - (taps / 2 - 1)) * grid.stride + (c0 - (taps / 2 - 1)) * 4;
    for (int v = 0; v < vectors; ++v) sum[v] = hn::Mul(hn::LoadU(d, from + v * lanes), hn::Set(d, down[0]));
    for (int k = 1; k < taps; ++k) {
        from += grid.stride;
        const auto weight = hn::Set(d, down[k]);
        for (int v = 0; v < vectors; ++v) sum[v] = hn::MulAdd(hn::LoadU(d, from + v * lanes), weight, sum[v]);
    }
    const float* across = table.across.data() + std::size_t(ic) * quads;
    const auto t = hn::Set(d, tc);
    auto total = hn::Zero(d);
    for (int v = 0; v < vectors; ++v) {
        const auto low = hn::LoadU(d, across + v * lanes), high = hn::LoadU(d, across + quads + v * lanes);
        total = hn::MulAdd(hn::MulAdd(t, hn::Sub(high, low), low), sum[v], total);
    }
    alignas(64) float parts[lanes];
    hn::Store(total, d, parts);
    for (int c = 0; c < 3; ++c) {
        float value = parts[c];
        for (int p = 4; p < lanes; p += 4) value += parts[p + c];
        rgb[c] = value;
    }
}

void lookup_directions(const GridView& grid, const TapTable& table, const double* x, const double* y, const double* z, int count, float* out) {
    double column[k_block], row[k_block], bx[k_block], by[k_block], bz[k_block];
    for (int i = 0; i < count; i += k_block) {
        const int n = std::min(k_block, count - i);
        const double *px = x + i, *py = y + i, *pz = z + i;
        if (n < k_block) {  // whole vectors only: the rest looks at +X
            for (int k = 0; k < k_block; ++k) {
                bx[k] = k < n ? px[k] : 1;
                by[k] = k < n ? py[k] : 0;
                bz[k] = k < n ? pz[k] : 0;
            }
            px = bx, py = by, pz = bz;
        }
        grid_coordinates(grid, px, py, pz, k_block, column, row);
        for (int k = 0; k < n; ++k) lookup_one(grid, table, column[k], row[k], out + 3 * std::size_t(i + k));
    }
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(lookup_directions);

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

void lookup_directions(const GridView& grid, const TapTable& table, const double* x, const double* y, const double* z, int count, float* out) {
    HWY_DYNAMIC_DISPATCH(lookup_directions)(grid, table, x, y, z, count, out);
}

}  // namespace domelight::simd
#endif
