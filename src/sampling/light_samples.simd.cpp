#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sampling/light_samples.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/cache_control.h>
// clang-format on

#include "sampling/light_samples.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;
using VI = hn::Vec<hn::RebindToSigned<D>>;

/// cos and sin of 2 pi t, t in [-1, 1]: the nearest quarter turn, and Taylor's series for the rest, |x| <= pi / 4.
/// Within 1.5e-7.
HWY_INLINE void turn_cosine_sine(V t, V& cosine, V& sine) {
    const D d;
    const hn::RebindToSigned<D> di;
    const V quarters = hn::Round(hn::Mul(t, hn::Set(d, 4.f)));
    const VI q = hn::ConvertTo(di, quarters);
    const V x = hn::Mul(hn::NegMulAdd(quarters, hn::Set(d, 0.25f), t), hn::Set(d, 6.283185307f)), x2 = hn::Mul(x, x);
    V s = hn::MulAdd(x2, hn::Set(d, 2.75573192e-6f), hn::Set(d, -1.98412698e-4f));
    s = hn::MulAdd(s, x2, hn::Set(d, 8.33333333e-3f));
    s = hn::MulAdd(s, x2, hn::Set(d, -1.66666667e-1f));
    s = hn::MulAdd(hn::Mul(s, x2), x, x);
    V c = hn::MulAdd(x2, hn::Set(d, 2.48015873e-5f), hn::Set(d, -1.38888889e-3f));
    c = hn::MulAdd(c, x2, hn::Set(d, 4.16666667e-2f));
    c = hn::MulAdd(c, x2, hn::Set(d, -0.5f));
    c = hn::MulAdd(c, x2, hn::Set(d, 1.f));
    const auto one = hn::Set(di, 1), two = hn::Set(di, 2);
    const auto odd = hn::RebindMask(d, hn::Eq(hn::And(q, one), one));
    const V a = hn::IfThenElse(odd, s, c), b = hn::IfThenElse(odd, c, s);
    const auto minus_cosine = hn::RebindMask(d, hn::Eq(hn::And(hn::Add(q, one), two), two));
    const auto minus_sine = hn::RebindMask(d, hn::Eq(hn::And(q, two), two));
    cosine = hn::IfThenElse(minus_cosine, hn::Neg(a), a);
    sine = hn::IfThenElse(minus_sine, hn::Neg(b), b);
}

constexpr int k_block = 64;

/// Directions and densities of a block.
HWY_INLINE void turn_block(const std::array<float, 9>& m, int count, float least_sine, const float* u, const float* v, float* pdf,
                           float* x, float* y, float* z) {
    const D d;
    const int lanes = int(hn::Lanes(d));
    alignas(64) float in[3][k_block] = {}, out[4][k_block];
    std::copy_n(u, count, in[0]);
    std::copy_n(v, count, in[1]);
    std::copy_n(pdf, count, in[2]);
    for (int i = 0; i < k_block; i += lanes) {
        V cos_phi, sin_phi, cos_theta, sin_theta;
        turn_cosine_sine(hn::Sub(hn::Load(d, in[0] + i), hn::Set(d, 0.5f)), cos_phi, sin_phi);
        // The lower half from the south pole: the sine keeps its digits there too.
        const V tv = hn::Load(d, in[1] + i), from_south = hn::Sub(hn::Set(d, 1.f), tv);
        const auto south = hn::Gt(tv, hn::Set(d, 0.5f));
        turn_cosine_sine(hn::Mul(hn::IfThenElse(south, from_south, tv), hn::Set(d, 0.5f)), cos_theta, sin_theta);
        cos_theta = hn::IfThenElse(south, hn::Neg(cos_theta), cos_theta);
        const V sx = hn::Mul(sin_theta, cos_phi), sz = hn::Mul(sin_theta, sin_phi);
        const auto turned = [&](int r) HWY_ATTR {
            return hn::MulAdd(hn::Set(d, m[r]), sx,
                              hn::MulAdd(hn::Set(d, m[r + 1]), cos_theta, hn::Mul(hn::Set(d, m[r + 2]), sz)));
        };
        hn::Store(turned(0), d, out[0] + i);
        hn::Store(turned(3), d, out[1] + i);
        hn::Store(turned(6), d, out[2] + i);
        const V area =
            hn::Mul(hn::Max(sin_theta, hn::Set(d, least_sine)), hn::Set(d, 19.739208802f));  // 2 pi^2 sin theta
        hn::Store(hn::Div(hn::Load(d, in[2] + i), area), d, out[3] + i);
    }
    std::copy_n(out[0], count, x);
    std::copy_n(out[1], count, y);
    std::copy_n(out[2], count, z);
    std::copy_n(out[3], count, pdf);
}

/// Radiance of a block: addresses and fetches first, so that the block's cache misses overlap.
HWY_INLINE void look_up_block(const LightImage& image, int count, const float* u, const float* v, float* r, float* g,
                              float* b) {
    const int w = image.width, h = image.height;
    if (!image.bilinear) {
        const float* at[k_block];
        for (int i = 0; i < count; ++i) {
            const int x = std::min(int(double(u[i]) * w), w - 1), y = std::min(int(double(v[i]) * h), h - 1);
            at[i] = image.rgb + y * image.stride + 3 * std::ptrdiff_t(x);
            hwy::Prefetch(at[i]);
        }
        for (int i = 0; i < count; ++i) r[i] = at[i][0], g[i] = at[i][1], b[i] = at[i][2];
        return;
    }
    const float *upper[k_block], *lower[k_block];
    float s[k_block], t[k_block];
    int right[k_block];  // floats to the right neighbour
    for (int i = 0; i < count; ++i) {
        // x + 1/2 and y + 1/2 are >= 0: int() is floor.
        const float x = u[i] * float(w) + 0.5f, y = v[i] * float(h) + 0.5f;
        const int x1 = std::min(int(x), w), y1 = std::min(int(y), h);
        s[i] = x - float(x1), t[i] = y - float(y1);
        const int left = x1 > 0 ? x1 - 1 : w - 1;
        right[i] = 3 * ((x1 < w ? x1 : 0) - left);
        upper[i] = image.rgb + std::max(y1 - 1, 0) * image.stride + 3 * std::ptrdiff_t(left);
        lower[i] = image.rgb + std::min(y1, h - 1) * image.stride + 3 * std::ptrdiff_t(left);
        hwy::Prefetch(upper[i]);
        hwy::Prefetch(lower[i]);
    }
    float* const out[3] = {r, g, b};
    for (int i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c) {
            const float a = upper[i][c], e = lower[i][c];
            const float above = a + s[i] * (upper[i][right[i] + c] - a),
                        below = e + s[i] * (lower[i][right[i] + c] - e);
            out[c][i] = std::max(above + t[i] * (below - above), 0.f);
        }
}

void complete_light_samples(const LightImage& image, const std::array<float, 9>& to_world, int count, float least_sine,
                            const float* u, const float* v, float* pdf, const std::array<float*, 3>& direction,
                            const std::array<float*, 3>& radiance) {
    for (int i = 0; i < count; i += k_block) {
        const int n = std::min(k_block, count - i);
        look_up_block(image, n, u + i, v + i, radiance[0] + i, radiance[1] + i, radiance[2] + i);
        turn_block(to_world, n, least_sine, u + i, v + i, pdf + i, direction[0] + i, direction[1] + i,
                   direction[2] + i);
    }
}

/// atan(q) / (2 pi q) on [0, 1] in powers of q^2, error 1e-8.
constexpr float k_atan[9] = {0.159154922f, -0.0530504733f, 0.031808544f, -0.0225382168f, 0.0167093556f, -0.0115142232f, 0.00633096695f, -0.00229182513f, 0.000390949979f};

/// atan2(y, x) / 2 pi, within 3e-8; 0 where both are 0.
HWY_INLINE V turn_of(V y, V x) {
    const D d;
    const V ax = hn::Abs(x), ay = hn::Abs(y), larger = hn::Max(hn::Max(ax, ay), hn::Set(d, 1e-30f));
    const V q = hn::Div(hn::Min(ax, ay), larger), q2 = hn::Mul(q, q);
    V p = hn::Set(d, k_atan[8]);
    for (int i = 7; i >= 0; --i) p = hn::MulAdd(p, q2, hn::Set(d, k_atan[i]));
    V a = hn::Mul(p, q);
    a = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(hn::Set(d, 0.25f), a), a);
    a = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, 0.5f), a), a);
    return hn::CopySign(a, y);
}

/// Points and sines of a block.
HWY_INLINE void place_block(const std::array<float, 9>& m, int count, const std::array<const float*, 3>& direction,
                            float* u, float* v, float* sine) {
    const D d;
    const int lanes = int(hn::Lanes(d));
    alignas(64) float in[3][k_block], out[3][k_block];
    for (int c = 0; c < 3; ++c) {
        std::copy_n(direction[c], count, in[c]);
        std::fill(in[c] + count, in[c] + k_block, 1.f);
    }
    for (int i = 0; i < count; i += lanes) {
        const V x = hn::Load(d, in[0] + i), y = hn::Load(d, in[1] + i), z = hn::Load(d, in[2] + i);
        const auto turned = [&](int r) HWY_ATTR {
            return hn::MulAdd(hn::Set(d, m[r]), x,
                              hn::MulAdd(hn::Set(d, m[r + 1]), y, hn::Mul(hn::Set(d, m[r + 2]), z)));
        };
        const V sx = turned(0), sy = turned(3), sz = turned(6);
        const V across2 = hn::MulAdd(sx, sx, hn::Mul(sz, sz)), across = hn::Sqrt(across2);
        const V under_one = hn::Set(d, 0x1.fffffep-1f), least = hn::Set(d, 1e-30f);
        V tu = hn::Add(turn_of(sz, sx), hn::Set(d, 0.5f));
        tu = hn::IfThenElse(hn::Ge(tu, hn::Set(d, 1.f)), hn::Zero(d), tu);
        const V tv = hn::Mul(turn_of(across, sy), hn::Set(d, 2.f));
        hn::Store(tu, d, out[0] + i);
        hn::Store(hn::Min(tv, under_one), d, out[1] + i);
        hn::Store(hn::Div(across, hn::Max(hn::Sqrt(hn::MulAdd(sy, sy, across2)), least)), d, out[2] + i);
    }
    std::copy_n(out[0], count, u);
    std::copy_n(out[1], count, v);
    std::copy_n(out[2], count, sine);
}

void look_up_light_samples(const LightImage& image, const std::array<float, 9>& to_source, int count,
                           const std::array<const float*, 3>& direction, float* u, float* v, float* sine,
                           const std::array<float*, 3>& radiance) {
    for (int i = 0; i < count; i += k_block) {
        const int n = std::min(k_block, count - i);
        place_block(to_source, n, {direction[0] + i, direction[1] + i, direction[2] + i}, u + i, v + i, sine + i);
        look_up_block(image, n, u + i, v + i, radiance[0] + i, radiance[1] + i, radiance[2] + i);
    }
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(complete_light_samples);

void complete_light_samples(const LightImage& image, const std::array<float, 9>& to_world, int count, float least_sine,
                            const float* u, const float* v, float* pdf, const std::array<float*, 3>& direction,
                            const std::array<float*, 3>& radiance) {
    HWY_DYNAMIC_DISPATCH(complete_light_samples)(image, to_world, count, least_sine, u, v, pdf, direction, radiance);
}

HWY_EXPORT(look_up_light_samples);

void look_up_light_samples(const LightImage& image, const std::array<float, 9>& to_source, int count,
                           const std::array<const float*, 3>& direction, float* u, float* v, float* sine,
                           const std::array<float*, 3>& radiance) {
    HWY_DYNAMIC_DISPATCH(look_up_light_samples)(image, to_source, count, direction, u, v, sine, radiance);
}

}  // namespace domelight::simd
#endif
