// Included once for each instruction set, by the kernels that draw from distributions.

#if defined(DOMELIGHT_SIMD_DISTRIBUTION_FLOAT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DOMELIGHT_SIMD_DISTRIBUTION_FLOAT_INL_H
#undef DOMELIGHT_SIMD_DISTRIBUTION_FLOAT_INL_H
#else
#define DOMELIGHT_SIMD_DISTRIBUTION_FLOAT_INL_H
#endif

#include <hwy/highway.h>

#include "base/float64-inl.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {

/// texel_float (sampling/distribution/texel_float.h) of `quotient` = x / n, operation by operation.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE auto texel_floats(D d, V quotient, V item, V n, V one) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::Rebind<float, D> df;
    auto f = hn::PromoteTo(d, hn::DemoteTo(df, quotient));
    const auto back = hn::Mul(f, n);
    f = hn::IfThenElse(hn::Ge(back, hn::Add(item, one)), hn::Mul(f, hn::Set(d, 1 - 1.5 * 0x1p-24)), f);
    f = hn::IfThenElse(hn::Lt(back, item), hn::Mul(f, hn::Set(d, 1 + 1.5 * 0x1p-24)), f);
    return hn::DemoteTo(df, f);
}

constexpr int k_batch = 64;  ///< the number of points that are processed together

/// The output of a batch of `n` draws in whole vectors. The last batch, which may be short, goes through a buffer.
template <int size = k_batch>
struct BatchOutput {
    alignas(64) float buffer[3][size];
    float* target[3];
    float* to[3];  ///< u, v, pdf_uv: `size` of each
    int n;
    BatchOutput(float* u, float* v, float* pdf_uv, int n_) : target{u, v, pdf_uv}, n(n_) {
        for (int i = 0; i < 3; ++i) to[i] = n == size ? target[i] : buffer[i];
    }
    HWY_INLINE void finish() const {
        for (int i = 0; n < size && i < 3; ++i) std::copy_n(buffer[i], n, target[i]);
    }
};

/// Items drawn in one direction: the position in each is (offset + 1/2) / length, its density quanta / 2^32 items.
struct ItemDraws {
    const double *item, *offset, *length, *quanta;
    double items;
};

/// Points and densities of draws of a column and a row, both piecewise constant.
HWY_INLINE void store_texel_draws(const ItemDraws& columns, const ItemDraws& rows, const BatchOutput<>& out) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::ScalableTag<double> d;
    const hn::Rebind<float, decltype(d)> df;
    const double scale = columns.items * rows.items * 0x1p-64;
    for (int k = 0; k < k_batch; k += int(hn::Lanes(d))) {
        const auto half = hn::Set(d, 0.5), one = hn::Set(d, 1.0);
        const auto position = [&](const ItemDraws& draws, float* to) HWY_ATTR {
            const auto item = hn::Load(d, draws.item + k);
            const auto x =
                hn::Add(item, hn::Div(hn::Add(hn::Load(d, draws.offset + k), half), hn::Load(d, draws.length + k)));
            hn::StoreU(texel_floats(d, hn::Mul(x, hn::Set(d, 1.0 / draws.items)), item, hn::Set(d, draws.items), one),
                       df, to + k);
        };
        position(columns, out.to[0]);
        position(rows, out.to[1]);
        const auto density =
            hn::Mul(hn::Mul(hn::Load(d, rows.quanta + k), hn::Load(d, columns.quanta + k)), hn::Set(d, scale));
        hn::StoreU(hn::DemoteTo(df, density), df, out.to[2] + k);
    }
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
