// Vector forms of texture/texel/encode_row.cpp, which explains each step.
#include "texture/texel/encode_row_simd.h"

#include "texture/texel/half.h"
#include "texture/texel/r11g11b10f.h"
#include "texture/texel/rgb9e5.h"

#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texture/texel/encode_row.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Three channels of some texels.
template <typename V>
struct Rgb {
    V r, g, b;
};

/// Stores texels that are inside the range and returns the stored values. Half floats use the processor's conversion,
/// which rounds to nearest even.
struct HalfCoder {
    static constexpr int k_bytes = 8;
    static constexpr bool k_exact = false;
    static constexpr float k_min = -k_half_max, k_max = k_half_max, k_max_blue = k_half_max;
#if HWY_TARGET == HWY_WASM
    // WebAssembly has no such conversion: half_from_float() and float_from_half() with vectors.
    template <typename D, typename V = hn::Vec<D>>
    static Rgb<V> store(D d, const Rgb<V>& v, std::uint8_t* out) {
        const hn::Rebind<std::uint16_t, D> du16;
        const auto r = half(d, v.r), g = half(d, v.g), b = half(d, v.b);
        hn::StoreInterleaved4(hn::TruncateTo(du16, r), hn::TruncateTo(du16, g), hn::TruncateTo(du16, b),
                              hn::Set(du16, std::uint16_t(0x3c00)), du16, reinterpret_cast<std::uint16_t*>(out));
        return {decoded(d, r), decoded(d, g), decoded(d, b)};
    }

  private:
    template <typename D, typename V = hn::Vec<D>>
    static hn::Vec<hn::Rebind<std::uint32_t, D>> half(D d, V value) {
        const hn::Rebind<std::uint32_t, D> du;
        const auto all = hn::BitCast(du, value), bits = hn::And(all, hn::Set(du, 0x7fffffffu));
        const auto sign = hn::And(hn::ShiftRight<16>(all), hn::Set(du, 0x8000u));
        const auto sum = hn::Add(hn::BitCast(d, bits), hn::Set(d, 0.5f));
        const auto subnormal = hn::Sub(hn::BitCast(du, sum), hn::Set(du, 0x3f000000u));
        const auto odd = hn::And(hn::ShiftRight<13>(bits), hn::Set(du, 1u));
        const auto normal = hn::ShiftRight<13>(hn::Add(hn::Add(bits, hn::Set(du, 0xc8000fffu)), odd));
        const auto is_normal = hn::Ge(hn::BitCast(d, bits), hn::Set(d, 0x1p-14f));
        return hn::Or(sign, hn::IfThenElse(hn::RebindMask(du, is_normal), normal, subnormal));
    }
    template <typename D, typename U>
    static hn::Vec<D> decoded(D d, U half) {
        const hn::Rebind<std::uint32_t, D> du;
        const auto sign = hn::ShiftLeft<16>(hn::And(half, hn::Set(du, 0x8000u)));
        // The exponent's bias is 112 larger; the product is exact, also of subnormal halves.
        const auto magnitude = hn::ShiftLeft<13>(hn::And(half, hn::Set(du, 0x7fffu)));
        const auto value = hn::Mul(hn::BitCast(d, magnitude), hn::Set(d, 0x1p112f));
        return hn::BitCast(d, hn::Or(sign, hn::BitCast(du, value)));
    }
#else
    template <typename D, typename V = hn::Vec<D>>
    static Rgb<V> store(D d, const Rgb<V>& v, std::uint8_t* out) {
        const hn::Rebind<hwy::float16_t, D> dh;
        const hn::Rebind<std::uint16_t, D> du;
        const auto r = hn::DemoteTo(dh, v.r), g = hn::DemoteTo(dh, v.g), b = hn::DemoteTo(dh, v.b);
        hn::StoreInterleaved4(hn::BitCast(du, r), hn::BitCast(du, g), hn::BitCast(du, b),
                              hn::Set(du, std::uint16_t(0x3c00)), du, reinterpret_cast<std::uint16_t*>(out));
        return {hn::PromoteTo(d, r), hn::PromoteTo(d, g), hn::PromoteTo(d, b)};
    }
#endif
};

struct FloatCoder {
    static constexpr int k_bytes = 16;
    static constexpr bool k_exact = true;
    static constexpr float k_max = std::numeric_limits<float>::max(), k_min = -k_max, k_max_blue = k_max;
    template <typename D, typename V = hn::Vec<D>>
    static Rgb<V> store(D d, const Rgb<V>& v, std::uint8_t* out) {
        hn::StoreInterleaved4(v.r, v.g, v.b, hn::Set(d, 1.0f), d, reinterpret_cast<float*>(out));
        return v;
    }
};

struct Rgb9e5Coder {
    static constexpr int k_bytes = 4;
    static constexpr bool k_exact = false;
    static constexpr float k_min = 0, k_max = k_rgb9e5_max, k_max_blue = k_rgb9e5_max;
    template <typename D, typename V = hn::Vec<D>>
    static Rgb<V> store(D d, const Rgb<V>& v, std::uint8_t* out) {
        const hn::RebindToSigned<D> di;
        const auto largest = hn::Max(v.r, hn::Max(v.g, v.b));
        const auto floor_log2 = hn::Sub(hn::ShiftRight<23>(hn::BitCast(di, largest)), hn::Set(di, 127));
        auto exponent = hn::Add(hn::Max(floor_log2, hn::Set(di, -16)), hn::Set(di, 16));
        const auto half = hn::Set(d, 0.5f);
        const auto inverse_step = [&](auto e) HWY_ATTR {
            return hn::BitCast(d, hn::ShiftLeft<23>(hn::Sub(hn::Set(di, 127 + 24), e)));
        };
        const auto mantissa = [&](auto c, auto scale)
                                  HWY_ATTR { return hn::ConvertTo(di, hn::Add(hn::Mul(c, scale), half)); };
        const auto carries = hn::Eq(mantissa(largest, inverse_step(exponent)), hn::Set(di, 512));
        exponent = hn::Add(exponent, hn::IfThenElseZero(carries, hn::Set(di, 1)));
        const auto scale = inverse_step(exponent);
        const auto r = mantissa(v.r, scale), g = mantissa(v.g, scale), b = mantissa(v.b, scale);
        const auto packed =
            hn::Or(hn::Or(r, hn::ShiftLeft<9>(g)), hn::Or(hn::ShiftLeft<18>(b), hn::ShiftLeft<27>(exponent)));
        hn::StoreU(packed, di, reinterpret_cast<std::int32_t*>(out));
        const auto step = hn::BitCast(d, hn::ShiftLeft<23>(hn::Add(exponent, hn::Set(di, 127 - 24))));
        return {hn::Mul(hn::ConvertTo(d, r), step), hn::Mul(hn::ConvertTo(d, g), step),
                hn::Mul(hn::ConvertTo(d, b), step)};
    }
};

/// Bits of the nearest small unsigned float; `rounded` becomes its value.
template <int mantissa_bits, typename D, typename V = hn::Vec<D>>
hn::Vec<hn::RebindToUnsigned<D>> small_float(D d, V v, V& rounded) {
    const hn::RebindToUnsigned<D> du;
    constexpr int k_shift = 23 - mantissa_bits;
    const auto bits = hn::BitCast(du, v);
    const auto odd = hn::And(hn::ShiftRight<k_shift>(bits), hn::Set(du, 1u));
    const auto shifted =
        hn::ShiftRight<k_shift>(hn::Add(bits, hn::Add(odd, hn::Set(du, 0xc8000000u + ((1u << (k_shift - 1)) - 1)))));
    const auto align = hn::Set(d, float(1 << (9 - mantissa_bits)));
    const auto aligned = hn::Add(v, align);
    const auto is_small = hn::Lt(v, hn::Set(d, 0x1p-14f));
    const auto normal_value = hn::BitCast(d, hn::Add(hn::ShiftLeft<k_shift>(shifted), hn::Set(du, 112u << 23)));
    rounded = hn::IfThenElse(is_small, hn::Sub(aligned, align), normal_value);
    return hn::IfThenElse(hn::RebindMask(du, is_small), hn::Sub(hn::BitCast(du, aligned), hn::BitCast(du, align)),
                          shifted);
}

struct R11g11b10fCoder {
    static constexpr int k_bytes = 4;
    static constexpr bool k_exact = false;
    static constexpr float k_min = 0, k_max = k_float11_max, k_max_blue = k_float10_max;
    template <typename D, typename V = hn::Vec<D>>
    static Rgb<V> store(D d, const Rgb<V>& v, std::uint8_t* out) {
        const hn::RebindToUnsigned<D> du;
        Rgb<V> rounded = v;
        const auto r = small_float<6>(d, v.r, rounded.r), g = small_float<6>(d, v.g, rounded.g),
                   b = small_float<5>(d, v.b, rounded.b);
        hn::StoreU(hn::Or(r, hn::Or(hn::ShiftLeft<11>(g), hn::ShiftLeft<22>(b))), du,
                   reinterpret_cast<std::uint32_t*>(out));
        return rounded;
    }
};

/// The partial EncodeSums of a row, one for each lane.
class Accumulator {
    using D = hn::ScalableTag<float>;
    using V = hn::Vec<D>;

  public:
    Accumulator(float low, float high, float high_blue, float log_floor)
        : low_(hn::Set(d_, low)),
          high_(hn::Set(d_, high)),
          high_blue_(hn::Set(d_, high_blue)),
          floor_(hn::Set(d_, log_floor)) {}

    static Rgb<V> load(const float* rgb) {
        Rgb<V> read{hn::Undefined(d_), hn::Undefined(d_), hn::Undefined(d_)};
        hn::LoadInterleaved3(d_, rgb, read.r, read.g, read.b);
        return read;
    }
    /// Inside the range; NaN becomes 0.
    Rgb<V> limit(const Rgb<V>& read) const {
        const Rgb<V> v = numbers(read);
        return {hn::Min(hn::Max(v.r, low_), high_), hn::Min(hn::Max(v.g, low_), high_),
                hn::Min(hn::Max(v.b, low_), high_blue_)};
    }
    /// See EncodeSums::add. `exact`: `stored` is `inside`.
    void add(const Rgb<V>& read, const Rgb<V>& inside, const Rgb<V>& stored, V w, bool exact) {
        const Rgb<V> v = numbers(read);
        power_ = hn::Add(power_, hn::Mul(w, luminance(v)));
        // Not Ne: that is false for NaN.
        const auto kept =
            hn::And(hn::Eq(read.r, inside.r), hn::And(hn::Eq(read.g, inside.g), hn::Eq(read.b, inside.b)));
        const auto clipped = hn::Not(kept);
        if (HWY_UNLIKELY(!hn::AllFalse(d_, clipped))) {
            clipped_ += std::int64_t(hn::CountTrue(d_, clipped));
            const Rgb<V> above = minus(v, inside);
            const auto zero = hn::Zero(d_);
            const Rgb<V> lost_here{hn::Max(above.r, zero), hn::Max(above.g, zero), hn::Max(above.b, zero)};
            lost_ = hn::Add(lost_, hn::Mul(w, luminance(lost_here)));
            w = hn::IfThenZeroElse(clipped, w);
        }
        log_norm_ = hn::Add(log_norm_, hn::Mul(w, hn::Set(d_, 3.0f)));
        if (exact) return;
        error_ = hn::Add(error_, hn::Mul(w, square(minus(stored, inside))));
        norm_ = hn::Add(norm_, hn::Mul(w, square(inside)));
        const Rgb<V> ratio{log_ratio(stored.r, inside.r), log_ratio(stored.g, inside.g), log_ratio(stored.b, inside.b)};
        log_error_ = hn::Add(log_error_, hn::Mul(w, square(ratio)));
    }
    EncodeSums finish() const {
        EncodeSums sums;
        sums.clipped = clipped_;
        sums.power = sum(power_);
        sums.lost = sum(lost_);
        sums.error = sum(error_);
        sums.norm = sum(norm_);
        sums.log_error = sum(log_error_);
        sums.log_norm = sum(log_norm_);
        return sums;
    }

  private:
    static Rgb<V> numbers(const Rgb<V>& v) {
        return {hn::IfThenElseZero(hn::Eq(v.r, v.r), v.r), hn::IfThenElseZero(hn::Eq(v.g, v.g), v.g),
                hn::IfThenElseZero(hn::Eq(v.b, v.b), v.b)};
    }
    static V luminance(const Rgb<V>& v) {
        return hn::Add(hn::Mul(hn::Set(d_, 0.2126f), v.r),
                       hn::Add(hn::Mul(hn::Set(d_, 0.7152f), v.g), hn::Mul(hn::Set(d_, 0.0722f), v.b)));
    }
    static V square(const Rgb<V>& v) {
        return hn::Add(hn::Mul(v.r, v.r), hn::Add(hn::Mul(v.g, v.g), hn::Mul(v.b, v.b)));
    }
    static Rgb<V> minus(const Rgb<V>& a, const Rgb<V>& b) {
        return {hn::Sub(a.r, b.r), hn::Sub(a.g, b.g), hn::Sub(a.b, b.b)};
    }
    V log_ratio(V now, V before) const {
        const auto zero = hn::Zero(d_);
        return hn::Log2(d_, hn::Div(hn::Add(hn::Max(now, zero), floor_), hn::Add(hn::Max(before, zero), floor_)));
    }
    static double sum(V v) { return double(hn::GetLane(hn::SumOfLanes(d_, v))); }

    static constexpr D d_{};
    V low_, high_, high_blue_, floor_;
    V power_ = hn::Zero(d_), lost_ = power_, error_ = power_, norm_ = power_, log_error_ = power_, log_norm_ = power_;
    std::int64_t clipped_ = 0;
};

template <typename Coder>
EncodeSums encode_row_with(Encoding encoding, const float* rgb, int count, const float* weight, float log_floor,
                           std::uint8_t* out) {
    const hn::ScalableTag<float> d;
    const int lanes = int(hn::Lanes(d));
    Accumulator sums(Coder::k_min, Coder::k_max, Coder::k_max_blue, log_floor);
    int x = 0;
    for (; x + lanes <= count; x += lanes) {
        const auto read = Accumulator::load(rgb + 3 * x), inside = sums.limit(read);
        const auto stored = Coder::store(d, inside, out + std::size_t(x) * Coder::k_bytes);
        sums.add(read, inside, stored, hn::LoadU(d, weight + x), Coder::k_exact);
    }
    EncodeSums total = sums.finish();
    total += encode_row_scalar(encoding, rgb + 3 * x, count - x, weight + x, log_floor,
                               out + std::size_t(x) * Coder::k_bytes);
    return total;
}

EncodeSums compare_row_here(const float* rgb, const float* stored, int count, const float* weight, float low,
                            float high, float log_floor) {
    const hn::ScalableTag<float> d;
    const int lanes = int(hn::Lanes(d));
    Accumulator sums(low, high, high, log_floor);
    int x = 0;
    for (; x + lanes <= count; x += lanes) {
        const auto read = Accumulator::load(rgb + 3 * x);
        sums.add(read, sums.limit(read), Accumulator::load(stored + 3 * x), hn::LoadU(d, weight + x), false);
    }
    EncodeSums total = sums.finish();
    total += compare_row_scalar(rgb + 3 * x, stored + 3 * x, count - x, weight + x, low, high, log_floor);
    return total;
}

EncodeSums encode_row_here(Encoding encoding, const float* rgb, int count, const float* weight, float log_floor,
                           std::uint8_t* out) {
    switch (encoding) {
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL || HWY_TARGET == HWY_NEON || \
    HWY_TARGET == HWY_WASM
        // Only where the processor converts, or the coder does: Highway's own emulation rounds differently.
        case Encoding::rgba16f:
            return encode_row_with<HalfCoder>(encoding, rgb, count, weight, log_floor, out);
#endif
#if HWY_TARGET != HWY_SCALAR
        case Encoding::rgb9e5:
            return encode_row_with<Rgb9e5Coder>(encoding, rgb, count, weight, log_floor, out);
        case Encoding::r11g11b10f:
            return encode_row_with<R11g11b10fCoder>(encoding, rgb, count, weight, log_floor, out);
#endif
        default:
            return encode_row_scalar(encoding, rgb, count, weight, log_floor, out);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace domelight::simd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(encode_row_here);
HWY_EXPORT(compare_row_here);

EncodeSums encode_row(Encoding encoding, const float* rgb, int count, const float* weight, float log_floor,
                      std::uint8_t* out) {
    return HWY_DYNAMIC_DISPATCH(encode_row_here)(encoding, rgb, count, weight, log_floor, out);
}

EncodeSums compare_row(const float* rgb, const float* stored, int count, const float* weight, float low, float high,
                       float log_floor) {
    return HWY_DYNAMIC_DISPATCH(compare_row_here)(rgb, stored, count, weight, low, high, log_floor);
}

}  // namespace domelight::simd
#endif
