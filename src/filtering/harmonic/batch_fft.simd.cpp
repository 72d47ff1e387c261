#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filtering/harmonic/batch_fft.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "base/aligned.h"
#include "filtering/harmonic/batch_fft.h"
#include <cmath>
#include <numbers>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, k_fft_lanes>;
using V = hn::Vec<D>;

struct Complex {
    V re, im;
};

HWY_INLINE Complex operator+(Complex a, Complex b) {
    return {hn::Add(a.re, b.re), hn::Add(a.im, b.im)};
}
HWY_INLINE Complex operator-(Complex a, Complex b) {
    return {hn::Sub(a.re, b.re), hn::Sub(a.im, b.im)};
}
/// a * (c + sqrt(-1) s)
HWY_INLINE Complex turn(Complex a, V c, V s) {
    return {hn::NegMulAdd(a.im, s, hn::Mul(a.re, c)), hn::MulAdd(a.im, c, hn::Mul(a.re, s))};
}
/// a * sqrt(-1) * sign
template <int sign>
HWY_INLINE Complex turn_quarter(Complex a) {
    if constexpr (sign > 0) return {hn::Neg(a.im), a.re};
    return {a.im, hn::Neg(a.re)};
}
HWY_INLINE Complex load(const float* element) {
    return {hn::Load(D(), element), hn::Load(D(), element + k_fft_lanes)};
}
HWY_INLINE void store(Complex a, float* element) {
    hn::Store(a.re, D(), element);
    hn::Store(a.im, D(), element + k_fft_lanes);
}

constexpr int k_element = 2 * k_fft_lanes;

/// sign = -1 forward, +1 inverse: y_q = sum_p x_p exp(sign 2 pi sqrt(-1) p q / r).
template <int sign>
HWY_INLINE void butterfly2(Complex* x) {
    const Complex a = x[0], b = x[1];
    x[0] = a + b;
    x[1] = a - b;
}
template <int sign>
HWY_INLINE void butterfly4(Complex* x) {
    const Complex s0 = x[0] + x[2], d0 = x[0] - x[2], s1 = x[1] + x[3], d1 = turn_quarter<sign>(x[1] - x[3]);
    x[0] = s0 + s1;
    x[1] = d0 + d1;
    x[2] = s0 - s1;
    x[3] = d0 - d1;
}
template <int sign>
HWY_INLINE void butterfly3(Complex* x) {
    const D d;
    const V half = hn::Set(d, 0.5f), s = hn::Set(d, float(sign * 0.86602540378443864676));
    const Complex sum = x[1] + x[2], dif = x[1] - x[2];
    const Complex mid = {hn::NegMulAdd(half, sum.re, x[0].re), hn::NegMulAdd(half, sum.im, x[0].im)};
    const Complex rot = {hn::Neg(hn::Mul(s, dif.im)), hn::Mul(s, dif.re)};
    x[0] = x[0] + sum;
    x[1] = mid + rot;
    x[2] = mid - rot;
}
template <int sign>
HWY_INLINE void butterfly5(Complex* x) {
    const D d;
    const V c1 = hn::Set(d, 0.30901699437494742410f), c2 = hn::Set(d, -0.80901699437494742410f);
    const V s1 = hn::Set(d, float(sign * 0.95105651629515357212)),
            s2 = hn::Set(d, float(sign * 0.58778525229247312917));
    const Complex a = x[1] + x[4], b = x[2] + x[3], e = x[1] - x[4], f = x[2] - x[3];
    const auto combine = [&](V ca, V cb) {
        return Complex{hn::MulAdd(ca, a.re, hn::MulAdd(cb, b.re, x[0].re)),
                       hn::MulAdd(ca, a.im, hn::MulAdd(cb, b.im, x[0].im))};
    };
    const Complex m1 = combine(c1, c2), m2 = combine(c2, c1);
    const Complex r1 = {hn::Neg(hn::MulAdd(s1, e.im, hn::Mul(s2, f.im))), hn::MulAdd(s1, e.re, hn::Mul(s2, f.re))};
    const Complex r2 = {hn::Neg(hn::MulSub(s2, e.im, hn::Mul(s1, f.im))), hn::MulSub(s2, e.re, hn::Mul(s1, f.re))};
    x[0] = x[0] + a + b;
    x[1] = m1 + r1;
    x[4] = m1 - r1;
    x[2] = m2 + r2;
    x[3] = m2 - r2;
}

/// Any radix, by the definition, for the rare large prime factor of a width.
template <int sign>
void butterfly_any(const BatchFft& plan, int r, const float* x, float* y) {
    const D d;
    const int step = plan.size() / r;
    for (int q = 0; q < r; ++q)
        for (int lane = 0; lane < k_fft_lanes; lane += int(hn::Lanes(d))) {
            Complex sum = load(x + lane);
            for (int p = 1; p < r; ++p) {
                const float* w = plan.twiddles() + 2 * (std::size_t(std::int64_t(p) * q % r) * step);
                sum = sum + turn(load(x + p * k_element + lane), hn::Set(d, w[0]), hn::Set(d, float(-sign) * w[1]));
            }
            store(sum, y + q * k_element + lane);
        }
}

/// One stage on one block: radix r over elements `sub` apart. The twiddle factors are applied after the butterfly in
/// the forward transform (decimation in frequency) and before it in the inverse.
template <int sign, int r>
HWY_INLINE void stage(const BatchFft& plan, float* data, int sub, int twiddle_step) {
    const D d;
    const float* w = plan.twiddles();
    for (int j = 0; j < sub; ++j)
        for (int lane = 0; lane < k_fft_lanes; lane += int(hn::Lanes(d))) {
            Complex x[r];
            float* element = data + j * k_element + lane;
            for (int p = 0; p < r; ++p) x[p] = load(element + std::size_t(p) * sub * k_element);
            const auto twist = [&] {
                if (j == 0) return;
                for (int q = 1; q < r; ++q) {
                    const float* t = w + 2 * std::size_t(j) * q * twiddle_step;
                    x[q] = turn(x[q], hn::Set(d, t[0]), hn::Set(d, float(-sign) * t[1]));
                }
            };
            if constexpr (sign > 0) twist();
            if constexpr (r == 2) butterfly2<sign>(x);
            if constexpr (r == 3) butterfly3<sign>(x);
            if constexpr (r == 4) butterfly4<sign>(x);
            if constexpr (r == 5) butterfly5<sign>(x);
            if constexpr (sign < 0) twist();
            for (int p = 0; p < r; ++p) store(x[p], element + std::size_t(p) * sub * k_element);
        }
}

template <int sign>
void stage_any(const BatchFft& plan, float* data, int r, int sub, int twiddle_step) {
    const D d;
    AlignedArray<float> buffer(std::size_t(2) * r * k_element, false);
    float *x = buffer.data(), *y = x + r * k_element;
    const auto twist = [&](float* v, int j) {
        for (int q = 1; q < r; ++q) {
            const float* t = plan.twiddles() + 2 * std::size_t(j) * q * twiddle_step;
            for (int lane = 0; lane < k_fft_lanes; lane += int(hn::Lanes(d)))
                store(turn(load(v + q * k_element + lane), hn::Set(d, t[0]), hn::Set(d, float(-sign) * t[1])),
                      v + q * k_element + lane);
        }
    };
    for (int j = 0; j < sub; ++j) {
        for (int p = 0; p < r; ++p)
            for (int i = 0; i < k_element; ++i) x[p * k_element + i] = data[(j + std::size_t(p) * sub) * k_element + i];
        if (sign > 0) twist(x, j);
        butterfly_any<sign>(plan, r, x, y);
        if (sign < 0) twist(y, j);
        for (int p = 0; p < r; ++p)
            for (int i = 0; i < k_element; ++i) data[(j + std::size_t(p) * sub) * k_element + i] = y[p * k_element + i];
    }
}

/// Depth first, so that the later stages work in the first-level cache.
template <int sign>
void transform(const BatchFft& plan, float* data, int n, std::size_t depth) {
    if (depth == plan.radices().size()) return;
    const int r = plan.radices()[depth], sub = n / r, twiddle_step = plan.size() / n;
    const auto here = [&] {
        switch (r) {
            case 2:
                stage<sign, 2>(plan, data, sub, twiddle_step);
                break;
            case 3:
                stage<sign, 3>(plan, data, sub, twiddle_step);
                break;
            case 4:
                stage<sign, 4>(plan, data, sub, twiddle_step);
                break;
            case 5:
                stage<sign, 5>(plan, data, sub, twiddle_step);
                break;
            default:
                stage_any<sign>(plan, data, r, sub, twiddle_step);
        }
    };
    if (sign < 0) here();
    for (int q = 0; q < r; ++q) transform<sign>(plan, data + std::size_t(q) * sub * k_element, sub, depth + 1);
    if (sign > 0) here();
}

void forward(const BatchFft& plan, float* data) {
    transform<-1>(plan, data, plan.size(), 0);
}
void inverse(const BatchFft& plan, float* data) {
    transform<1>(plan, data, plan.size(), 0);
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(forward);
HWY_EXPORT(inverse);

BatchFft::BatchFft(int n) : n_(n), position_(n), twiddles_(2 * std::size_t(n)) {
    int rest = n;
    for (int r : {4, 2, 3, 5})
        while (rest % r == 0 && rest > 1) {
            radices_.push_back(r);
            rest /= r;
        }
    for (int r = 7; rest > 1; r += 2) {
        if (std::int64_t(r) * r > rest) r = rest;
        while (rest % r == 0) {
            radices_.push_back(r);
            rest /= r;
        }
    }
    for (int k = 0; k < n; ++k) {
        const double angle = -2 * std::numbers::pi * k / n;
        twiddles_[2 * k] = float(std::cos(angle));
        twiddles_[2 * k + 1] = float(std::sin(angle));
    }
    // f = q_1 + r_1 (q_2 + r_2 (...)) lies at q_1 n / r_1 + q_2 n / (r_1 r_2) + ...
    for (int f = 0; f < n; ++f) {
        int digits = f, sub = n, at = 0;
        for (int r : radices_) {
            sub /= r;
            at += digits % r * sub;
            digits /= r;
        }
        position_[f] = at;
    }
}

void BatchFft::forward(float* data) const {
    HWY_DYNAMIC_DISPATCH(forward)(*this, data);
}
void BatchFft::inverse(float* data) const {
    HWY_DYNAMIC_DISPATCH(inverse)(*this, data);
}

}  // namespace domelight::simd
#endif
