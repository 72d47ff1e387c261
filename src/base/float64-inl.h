// Included after highway.h by every kernel that computes in double precision, once for each instruction set.
//
// Highway 1.0 has no vectors of doubles for WebAssembly, although its SIMD has them. These are the functions on them that
// our kernels, and Highway's Exp and Atan, use; Load, Store, BitCast and the like are Highway's own.

#include <hwy/highway.h>

#if defined(__wasm_simd128__) && !HWY_HAVE_FLOAT64

#undef HWY_HAVE_FLOAT64
#define HWY_HAVE_FLOAT64 1

HWY_BEFORE_NAMESPACE();
namespace hwy::HWY_NAMESPACE {

template <std::size_t N>
using Double128 = Vec128<double, N>;
template <std::size_t N>
using DoubleMask128 = Mask128<double, N>;

template <std::size_t N>
HWY_API Double128<N> Zero(Simd<double, N, 0>) {
    return Double128<N>{wasm_f64x2_splat(0.0)};
}
template <std::size_t N>
HWY_API Double128<N> Set(Simd<double, N, 0>, double value) {
    return Double128<N>{wasm_f64x2_splat(value)};
}

template <std::size_t N>
HWY_API Double128<N> operator+(Double128<N> a, Double128<N> b) {
    return Double128<N>{wasm_f64x2_add(a.raw, b.raw)};
}
template <std::size_t N>
HWY_API Double128<N> operator-(Double128<N> a, Double128<N> b) {
    return Double128<N>{wasm_f64x2_sub(a.raw, b.raw)};
}
template <std::size_t N>
HWY_API Double128<N> operator*(Double128<N> a, Double128<N> b) {
    return Double128<N>{wasm_f64x2_mul(a.raw, b.raw)};
}
template <std::size_t N>
HWY_API Double128<N> operator/(Double128<N> a, Double128<N> b) {
    return Double128<N>{wasm_f64x2_div(a.raw, b.raw)};
}
template <std::size_t N>
HWY_API Double128<N> MulAdd(Double128<N> a, Double128<N> b, Double128<N> c) {
    return a * b + c;
}
template <std::size_t N>
HWY_API Double128<N> NegMulAdd(Double128<N> a, Double128<N> b, Double128<N> c) {
    return c - a * b;
}
template <std::size_t N>
HWY_API Double128<N> MulSub(Double128<N> a, Double128<N> b, Double128<N> c) {
    return a * b - c;
}
template <std::size_t N>
HWY_API Double128<N> Sqrt(Double128<N> a) {
    return Double128<N>{wasm_f64x2_sqrt(a.raw)};
}
template <std::size_t N>
HWY_API Double128<N> Abs(Double128<N> a) {
    return Double128<N>{wasm_f64x2_abs(a.raw)};
}
template <std::size_t N>
HWY_API Double128<N> Neg(Double128<N> a) {
    return Double128<N>{wasm_f64x2_neg(a.raw)};
}
template <std::size_t N>
HWY_API Double128<N> Floor(Double128<N> a) {
    return Double128<N>{wasm_f64x2_floor(a.raw)};
}
template <std::size_t N>
HWY_API Double128<N> Min(Double128<N> a, Double128<N> b) {
    return Double128<N>{wasm_f64x2_pmin(a.raw, b.raw)};
}
template <std::size_t N>
HWY_API Double128<N> Max(Double128<N> a, Double128<N> b) {
    return Double128<N>{wasm_f64x2_pmax(a.raw, b.raw)};
}

template <std::size_t N>
HWY_API DoubleMask128<N> operator==(Double128<N> a, Double128<N> b) {
    return DoubleMask128<N>{wasm_f64x2_eq(a.raw, b.raw)};
}
template <std::size_t N>
HWY_API DoubleMask128<N> operator!=(Double128<N> a, Double128<N> b) {
    return DoubleMask128<N>{wasm_f64x2_ne(a.raw, b.raw)};
}
template <std::size_t N>
HWY_API DoubleMask128<N> operator<(Double128<N> a, Double128<N> b) {
    return DoubleMask128<N>{wasm_f64x2_lt(a.raw, b.raw)};
}
template <std::size_t N>
HWY_API DoubleMask128<N> operator>(Double128<N> a, Double128<N> b) {
    return DoubleMask128<N>{wasm_f64x2_gt(a.raw, b.raw)};
}
template <std::size_t N>
HWY_API DoubleMask128<N> operator<=(Double128<N> a, Double128<N> b) {
    return DoubleMask128<N>{wasm_f64x2_le(a.raw, b.raw)};
}
template <std::size_t N>
HWY_API DoubleMask128<N> operator>=(Double128<N> a, Double128<N> b) {
    return DoubleMask128<N>{wasm_f64x2_ge(a.raw, b.raw)};
}

template <std::size_t N>
HWY_API Vec128<float, N> DemoteTo(Simd<float, N, 0>, Double128<N> v) {
    return Vec128<float, N>{wasm_f32x4_demote_f64x2_zero(v.raw)};
}
template <std::size_t N>
HWY_API Double128<N> PromoteTo(Simd<double, N, 0>, Vec128<float, N> v) {
    return Double128<N>{wasm_f64x2_promote_low_f32x4(v.raw)};
}

}  // namespace hwy::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
