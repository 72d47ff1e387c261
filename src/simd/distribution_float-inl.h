// Included once for each instruction set, by the kernels that draw from distributions.

#if defined(DOMELIGHT_SIMD_DISTRIBUTION_FLOAT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DOMELIGHT_SIMD_DISTRIBUTION_FLOAT_INL_H
#undef DOMELIGHT_SIMD_DISTRIBUTION_FLOAT_INL_H
#else
#define DOMELIGHT_SIMD_DISTRIBUTION_FLOAT_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {

/// texel_float (distribution/texel_float.h) of `quotient` = x / n, operation by operation.
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

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
