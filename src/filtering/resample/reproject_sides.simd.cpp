#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filtering/resample/reproject_sides.simd.cpp"
// clang-format off: the order is Highway's
#include "filtering/resample/reproject_sides.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "base/float64-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
using D4 = hn::CappedTag<double, 4>;
using V4 = hn::Vec<D4>;
constexpr std::size_t k_lanes = hn::MaxLanes(D()), k_channel_lanes = hn::MaxLanes(D4());
/// The vectors that four channels take.
constexpr std::size_t k_quad = 4 / k_channel_lanes;

HWY_INLINE V constant(double v) {
    return hn::Set(D(), v);
}

struct Parabola {
    V slope, curve;
};

/// edge_value of reproject_source.cpp.
HWY_INLINE V edge_value(V a, V b, V c, V d) {
    const V e = hn::Mul(hn::MulSub(constant(7), hn::Add(b, c), hn::Add(a, d)), constant(1.0 / 12));
    return hn::Min(hn::Max(e, hn::Min(b, c)), hn::Max(b, c));
}

/// parabola of reproject_source.cpp.
HWY_INLINE Parabola parabola(V a, V b, V c, V d, V e) {
    const V left = edge_value(a, b, c, d), right = edge_value(b, c, d, e);
    const auto monotone = hn::Gt(hn::Mul(hn::Sub(right, c), hn::Sub(c, left)), hn::Zero(D()));
    const V rise = hn::Sub(right, left), off = hn::Mul(rise, hn::NegMulAdd(constant(0.5), hn::Add(left, right), c)),
            sixth = hn::Mul(hn::Mul(rise, rise), constant(1.0 / 6)), thrice = hn::Mul(constant(3), c);
    const V new_left = hn::IfThenElse(hn::Gt(off, sixth), hn::NegMulAdd(constant(2), right, thrice), left),
            new_right = hn::IfThenElse(hn::Lt(off, hn::Neg(sixth)), hn::NegMulAdd(constant(2), left, thrice), right);
    const V curve = hn::Mul(constant(3), hn::NegMulAdd(constant(2), c, hn::Add(new_left, new_right)));
    return {hn::IfThenElseZero(monotone, hn::Sub(new_right, new_left)), hn::IfThenElseZero(monotone, curve)};
}

HWY_INLINE V depth(const Parabola& p) {
    return hn::NegMulAdd(constant(1.0 / 6), p.curve, hn::Mul(constant(0.5), hn::Abs(p.slope)));
}

void fill_cell_row(const CellRow& row, std::size_t count) {
    const D d;
    const hn::Rebind<float, D> df;
    const auto load = [&](const float* p) { return hn::PromoteTo(d, hn::LoadU(df, p)); };
    for (std::size_t k = 0; k < count; k += k_lanes) {
        const float* middle = row.rows[2] + k;
        const V mean = load(middle);
        const Parabola across = parabola(load(middle - 6), load(middle - 3), mean, load(middle + 3), load(middle + 6));
        const Parabola down =
            parabola(load(row.rows[0] + k), load(row.rows[1] + k), mean, load(row.rows[3] + k), load(row.rows[4] + k));
        // keep_positive of reproject_source.cpp.
        const V sum = hn::Add(depth(across), depth(down)), most = hn::Mul(constant(0.9), hn::Abs(mean));
        const V scale = hn::IfThenElse(hn::Gt(sum, most), hn::Div(most, sum), constant(1));
        const V down_slope = hn::Mul(down.slope, scale);
        hn::StoreU(hn::NegMulAdd(constant(row.density_slope / 12), down_slope, mean), d, row.value[0] + k);
        hn::StoreU(hn::Mul(across.slope, scale), d, row.value[1] + k);
        hn::StoreU(down_slope, d, row.value[2] + k);
        hn::StoreU(hn::Mul(across.curve, scale), d, row.value[3] + k);
        hn::StoreU(hn::Mul(down.curve, scale), d, row.value[4] + k);
    }
}

void sum_cell_row(const double* const value[5], std::span<const int> cell, const double* solid_angle, double* cells) {
    const D4 d;
    alignas(64) const double light[4] = {1, 1, 1, 0}, angle[4] = {0, 0, 0, 1};
    for (std::size_t q = 0; q < k_quad; ++q) {
        const std::size_t lane = q * k_channel_lanes;
        const auto is_light = hn::Ne(hn::LoadU(d, light + lane), hn::Zero(d));
        const V4 one = hn::LoadU(d, angle + lane);
        V4 total = hn::Zero(d), slope = total, curve = total;
        double* out = cells + lane;
        for (std::size_t k = 0; k < cell.size(); ++k, out += k_cell_doubles) {
            const V4 omega = hn::Set(d, solid_angle[k]);
            const std::size_t at = 3 * std::size_t(cell[k]) + lane;
            const auto scaled = [&](int which) {
                return hn::Mul(hn::IfThenElseZero(is_light, hn::LoadU(d, value[which] + at)), omega);
            };
            const V4 mean = hn::MulAdd(one, omega, scaled(0)), down = scaled(2), down2 = scaled(4);
            hn::Store(total, d, out);
            hn::Store(slope, d, out + 4);
            hn::Store(curve, d, out + 8);
            hn::Store(mean, d, out + 12);
            hn::Store(down, d, out + 16);
            hn::Store(down2, d, out + 20);
            hn::Store(scaled(1), d, out + 24);
            hn::Store(scaled(3), d, out + 28);
            total = hn::Add(total, mean), slope = hn::Add(slope, down), curve = hn::Add(curve, down2);
        }
    }
}

/// Lines on their way through the cells, one in a lane: from one crossing of a row or column of texel edges to the
/// next, as TileIntegrator::along.
struct Walk {
    V dx, dy, step_x, step_y, next_x, next_y, turn_x, turn_y, column, row, s;

    HWY_INLINE static void begin(V a, V delta, V& step, V& next, V& turn, V& cell) {
        const D d;
        const V zero = hn::Zero(d), one = constant(1);
        const auto still = hn::Eq(delta, zero), back = hn::Lt(delta, zero);
        cell = hn::Floor(a);
        cell = hn::IfThenElse(hn::And(back, hn::Eq(cell, a)), hn::Sub(cell, one), cell);
        step = hn::IfThenElse(still, zero, hn::Div(one, hn::Abs(delta)));
        const V ahead = hn::IfThenElse(back, hn::Sub(a, cell), hn::Sub(hn::Add(cell, one), a));
        next = hn::IfThenElse(still, constant(2), hn::Mul(ahead, step));
        turn = hn::IfThenElse(back, constant(-1), one);
    }
    HWY_INLINE Walk(V ax, V ay, V bx, V by) : dx(hn::Sub(bx, ax)), dy(hn::Sub(by, ay)), s(hn::Zero(D())) {
        begin(ax, dx, step_x, next_x, turn_x, column);
        begin(ay, dy, step_y, next_y, turn_y, row);
    }
    HWY_INLINE V end() const { return hn::Min(hn::Min(next_x, next_y), constant(1)); }
    /// Lines that have arrived stay in their last cell.
    HWY_INLINE void advance(V end) {
        const auto goes_on = hn::Lt(end, constant(1));
        const auto over_x = hn::And(goes_on, hn::Le(next_x, end)), over_y = hn::And(goes_on, hn::Le(next_y, end));
        column = hn::Add(column, hn::IfThenElseZero(over_x, turn_x));
        row = hn::Add(row, hn::IfThenElseZero(over_y, turn_y));
        next_x = hn::Add(next_x, hn::IfThenElseZero(over_x, step_x));
        next_y = hn::Add(next_y, hn::IfThenElseZero(over_y, step_y));
        s = end;
    }
};

HWY_INLINE V clamped(V v, double most) {
    return hn::Min(hn::Max(v, hn::Zero(D())), constant(most));
}

/// Whole numbers from 0 to 2^51 as integers.
HWY_INLINE auto integers(V v) {
    const hn::RebindToSigned<D> di;
    const V magic = constant(0x1p52);
    return hn::Sub(hn::BitCast(di, hn::Add(v, magic)), hn::BitCast(di, magic));
}

/// The integrals along a piece of a line within a cell of the eight functions that a cell's coefficients multiply, by
/// Gauss-Legendre nodes: three are exact to the fifth degree, and two to the third, which suffices without a slope.
template <int nodes>
HWY_INLINE void moments(V xi_middle, V eta_middle, V xi_half, V eta_half, V density_slope, V m[8]) {
    const V zero = hn::Zero(D());
    for (int k = 0; k < 8; ++k) m[k] = zero;
    for (int n = 0; n < nodes; ++n) {
        const double at = nodes == 2 ? (n ? 0.5773502691896257 : -0.5773502691896257) : (n - 1) * 0.7745966692414834,
                     weight = nodes == 2 ? 1
                              : n == 1   ? 8.0 / 9
                                         : 5.0 / 9;
        const V xi = hn::MulAdd(constant(at), xi_half, xi_middle), eta = hn::MulAdd(constant(at), eta_half, eta_middle);
        V w = hn::Mul(constant(weight), eta_half);
        if (nodes == 3) w = hn::Mul(w, hn::MulAdd(density_slope, eta, constant(1)));
        const V square = hn::MulSub(eta, eta, constant(1.0 / 12)), run = hn::Add(xi, constant(0.5)),
                bump = hn::MulSub(xi, xi, constant(0.25)), w_eta = hn::Mul(w, eta), w_square = hn::Mul(w, square),
                w_bump = hn::Mul(w, bump);
        m[0] = hn::Add(m[0], w);
        m[1] = hn::Add(m[1], w_eta);
        m[2] = hn::Add(m[2], w_square);
        m[3] = hn::MulAdd(w, run, m[3]);
        m[4] = hn::MulAdd(w_eta, run, m[4]);
        m[5] = hn::MulAdd(w_square, run, m[5]);
        m[6] = hn::MulAdd(constant(0.5), w_bump, m[6]);
        m[7] = hn::MulAdd(hn::Mul(constant(1.0 / 3), xi), w_bump, m[7]);
    }
}

template <int nodes>
HWY_INLINE void integrate(const SideTile& tile, const Lines& lines, std::size_t count) {
    const D d;
    const D4 d4;
    const V width = constant(tile.width), half_one = constant(0.5);
    HWY_ALIGN double moment[8 * k_lanes];
    HWY_ALIGN std::int64_t cell[k_lanes];
    for (std::size_t k = 0; k < count; k += k_lanes) {
        const V ax = hn::LoadU(d, lines.ax + k), ay = hn::LoadU(d, lines.ay + k);
        Walk walk(ax, ay, hn::LoadU(d, lines.bx + k), hn::LoadU(d, lines.by + k));
        V4 sum[k_lanes][k_quad];
        for (auto& lane : sum)
            for (V4& v : lane) v = hn::Zero(d4);
        while (true) {
            const V end = walk.end(), middle = hn::Mul(half_one, hn::Add(walk.s, end)),
                    half = hn::Mul(half_one, hn::Sub(end, walk.s));
            const V column = clamped(hn::Sub(walk.column, constant(tile.x0)), tile.width - 1),
                    row = clamped(hn::Sub(walk.row, constant(tile.y0)), tile.height - 1);
            // The middle of the piece as seen from the middle of the cell.
            const V xi =
                        hn::Sub(hn::MulAdd(middle, walk.dx, hn::Sub(ax, hn::Add(column, constant(tile.x0)))), half_one),
                    eta = hn::Sub(hn::MulAdd(middle, walk.dy, hn::Sub(ay, hn::Add(row, constant(tile.y0)))), half_one);
            V m[8];
            moments<nodes>(xi, eta, hn::Mul(half, walk.dx), hn::Mul(half, walk.dy),
                           nodes == 3 ? hn::GatherIndex(d, tile.density_slope, integers(row)) : hn::Zero(d), m);
            for (std::size_t i = 0; i < 8; ++i) hn::Store(m[i], d, moment + i * k_lanes);
            hn::Store(integers(hn::MulAdd(row, width, column)), hn::RebindToSigned<D>(), cell);
            for (std::size_t lane = 0; lane < k_lanes; ++lane) {
                const double* c = tile.cells + k_cell_doubles * std::size_t(cell[lane]);
                for (std::size_t q = 0; q < k_quad; ++q)
                    for (std::size_t i = 0; i < 8; ++i)
                        sum[lane][q] = hn::MulAdd(hn::Set(d4, moment[i * k_lanes + lane]),
                                                  hn::Load(d4, c + 4 * i + q * k_channel_lanes), sum[lane][q]);
            }
            if (hn::AllTrue(d, hn::Ge(end, constant(1)))) break;
            walk.advance(end);
        }
        for (std::size_t lane = 0; lane < k_lanes; ++lane)
            for (std::size_t q = 0; q < k_quad; ++q)
                hn::StoreU(sum[lane][q], d4, lines.sums + 4 * (k + lane) + q * k_channel_lanes);
    }
}

void integrate_sides(const SideTile& tile, const Lines& lines, std::size_t count) {
    if (tile.is_even)
        integrate<2>(tile, lines, count);
    else
        integrate<3>(tile, lines, count);
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(fill_cell_row);
HWY_EXPORT(sum_cell_row);
HWY_EXPORT(integrate_sides);

void fill_cell_row(const CellRow& row, std::size_t count) {
    HWY_DYNAMIC_DISPATCH(fill_cell_row)(row, count);
}
void sum_cell_row(const double* const value[5], std::span<const int> cell, const double* solid_angle, double* cells) {
    HWY_DYNAMIC_DISPATCH(sum_cell_row)(value, cell, solid_angle, cells);
}
void integrate_sides(const SideTile& tile, const Lines& lines, std::size_t count) {
    HWY_DYNAMIC_DISPATCH(integrate_sides)(tile, lines, count);
}

}  // namespace domelight::simd
#endif
