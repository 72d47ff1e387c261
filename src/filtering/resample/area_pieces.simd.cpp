#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filtering/resample/area_pieces.simd.cpp"
// clang-format off: the order is Highway's
#include "filtering/resample/area_pieces.h"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "base/float64-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;

/// asin x for |x| <= 0.1, to 1e-13 of it.
HWY_INLINE V small_asin(V x) {
    const D d;
    const V x2 = hn::Mul(x, x);
    V p = hn::Set(d, 63.0 / 2816);
    p = hn::MulAdd(p, x2, hn::Set(d, 35.0 / 1152));
    p = hn::MulAdd(p, x2, hn::Set(d, 5.0 / 112));
    p = hn::MulAdd(p, x2, hn::Set(d, 3.0 / 40));
    p = hn::MulAdd(p, x2, hn::Set(d, 1.0 / 6));
    return hn::MulAdd(hn::Mul(p, x2), x, x);
}

template <int nodes>
HWY_INLINE void integrate(const ArcPieces& pieces, std::size_t count, double kappa_, double columns, double rows,
                          bool reversed) {
    const D d;
    const double node2 = 0.5773502691896258, node3 = 0.7745966692414834;
    const V kappa = hn::Set(d, kappa_), kappa2 = hn::Set(d, kappa_ * kappa_), one = hn::Set(d, 1.0);
    const V per_column = hn::Set(d, columns), per_row = hn::Set(d, rows);
    for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
        const V a = hn::LoadU(d, pieces.from + k), b = hn::LoadU(d, pieces.to + k);
        const V column_tan = hn::LoadU(d, pieces.column_tan + k), column_cos = hn::LoadU(d, pieces.column_cos + k);
        const V row_cos = hn::LoadU(d, pieces.row_cos + k), row_sin = hn::LoadU(d, pieces.row_sin + k);
        const V half = hn::Mul(hn::Sub(b, a), hn::Set(d, 0.5)), middle = hn::Add(a, half);
        V ul = hn::Zero(d), ur = ul, ll = ul, lr = ul, left = ul, right = ul;
        for (int n = 0; n < nodes; ++n) {
            const double x = nodes == 2 ? (n ? node2 : -node2) : (n - 1) * node3, w = nodes == 2 ? 1
                                                                                      : n == 1   ? 8.0 / 9
                                                                                                 : 5.0 / 9;
            const V t = hn::MulAdd(half, hn::Set(d, x), middle), q = hn::MulAdd(t, t, one), p = hn::Add(q, kappa2);
            // cos psi = 1 / sqrt q; cos theta = kappa / sqrt p, sin theta = sqrt(q / p).
            const V root_q = hn::Sqrt(q), root_p = hn::Sqrt(p), inverse = hn::Div(one, hn::Mul(root_q, root_p));
            const V cos_psi = hn::Mul(root_p, inverse), root_p_inverse = hn::Mul(root_q, inverse);
            const V cos_theta = hn::Mul(kappa, root_p_inverse), sin_theta = hn::Mul(root_q, root_p_inverse);
            // From the row's centre down to theta: ∫ sin = zeroth, ∫ (t - row) sin t dt = first.
            const V below = small_asin(hn::MulSub(sin_theta, row_cos, hn::Mul(cos_theta, row_sin)));
            const V zeroth = hn::Sub(row_cos, cos_theta),
                    first = hn::NegMulAdd(below, cos_theta, hn::Sub(sin_theta, row_sin));
            const V lower = hn::Mul(first, per_row), upper = hn::Sub(zeroth, lower);
            const V u = hn::Mul(small_asin(hn::Mul(hn::Sub(t, column_tan), hn::Mul(cos_psi, column_cos))), per_column);
            // dpsi = cos^2 psi dT
            const V dpsi = hn::Mul(hn::Mul(half, hn::Set(d, w)), hn::Mul(cos_psi, cos_psi));
            const V to_right = hn::Mul(dpsi, u), to_left = hn::Sub(dpsi, to_right);
            ul = hn::MulAdd(upper, to_left, ul);
            ur = hn::MulAdd(upper, to_right, ur);
            ll = hn::MulAdd(lower, to_left, ll);
            lr = hn::MulAdd(lower, to_right, lr);
            left = hn::Add(left, to_left);
            right = hn::Add(right, to_right);
        }
        if (reversed) {
            V swap = ul;
            ul = ur, ur = swap;
            swap = ll, ll = lr, lr = swap;
            swap = left, left = right, right = swap;
        }
        hn::StoreInterleaved2(ul, ur, d, pieces.upper + 2 * k);
        hn::StoreInterleaved2(ll, lr, d, pieces.lower + 2 * k);
        hn::StoreInterleaved2(left, right, d, pieces.width + 2 * k);
    }
}

void integrate_arc_pieces(const ArcPieces& pieces, std::size_t count, double kappa, double columns, double rows,
                          int nodes, bool reversed) {
    if (nodes == 2)
        integrate<2>(pieces, count, kappa, columns, rows, reversed);
    else
        integrate<3>(pieces, count, kappa, columns, rows, reversed);
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(integrate_arc_pieces);

void integrate_arc_pieces(const ArcPieces& pieces, std::size_t count, double kappa, double columns_per_radian,
                          double rows_per_radian, int nodes, bool reversed) {
    HWY_DYNAMIC_DISPATCH(integrate_arc_pieces)(pieces, count, kappa, columns_per_radian, rows_per_radian, nodes,
                                               reversed);
}

}  // namespace domelight::simd
#endif
