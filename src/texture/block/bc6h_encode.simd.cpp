// The search of texture/block/bc6h_search-inl.h in vectors.
#include "texture/block/bc6h_encode_simd.h"

#include "texture/block/bc6h.h"
#include "texture/block/bc6h_encode.h"
#include "base/simd_targets.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texture/block/bc6h_encode.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace domelight::bc6h;

using D = hn::ScalableTag<float>;
constexpr D k_floats;
constexpr int k_max_lanes = int(HWY_MAX_BYTES / sizeof(float));

struct F {
    hn::Vec<D> v;
};
struct M {
    hn::Mask<D> m;
};

HWY_INLINE F operator+(const F& a, const F& b) {
    return {hn::Add(a.v, b.v)};
}
HWY_INLINE F operator-(const F& a, const F& b) {
    return {hn::Sub(a.v, b.v)};
}
HWY_INLINE F operator*(const F& a, const F& b) {
    return {hn::Mul(a.v, b.v)};
}
HWY_INLINE F operator/(const F& a, const F& b) {
    return {hn::Div(a.v, b.v)};
}
HWY_INLINE M operator<(const F& a, const F& b) {
    return {hn::Lt(a.v, b.v)};
}
HWY_INLINE M operator>(const F& a, const F& b) {
    return {hn::Gt(a.v, b.v)};
}
HWY_INLINE M operator&(const M& a, const M& b) {
    return {hn::And(a.m, b.m)};
}
HWY_INLINE int lane_count() {
    return int(hn::Lanes(k_floats));
}
HWY_INLINE F splat(float v) {
    return {hn::Set(k_floats, v)};
}
HWY_INLINE F load(const float* p) {
    return {hn::LoadU(k_floats, p)};
}
HWY_INLINE void store(const F& v, float* p) {
    hn::StoreU(v.v, k_floats, p);
}
HWY_INLINE F select(const M& m, const F& a, const F& b) {
    return {hn::IfThenElse(m.m, a.v, b.v)};
}
HWY_INLINE F smaller(const F& a, const F& b) {
    return {hn::Min(a.v, b.v)};
}
HWY_INLINE F larger(const F& a, const F& b) {
    return {hn::Max(a.v, b.v)};
}
HWY_INLINE F floor_of(const F& v) {
    return {hn::Floor(v.v)};
}
HWY_INLINE bool any(const M& m) {
    return !hn::AllFalse(k_floats, m.m);
}
/// half_from_float of numbers from 0 to 65504; see there.
HWY_INLINE F half_bits_of(const F& v) {
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    const auto bits = hn::BitCast(du, v.v);
    const auto odd = hn::And(hn::ShiftRight<13>(bits), hn::Set(du, 1u));
    const auto normal = hn::ShiftRight<13>(hn::Add(hn::Add(bits, hn::Set(du, 0xc8000fffu)), odd));
    const auto small = hn::Sub(hn::BitCast(du, hn::Add(v.v, hn::Set(k_floats, 0.5f))), hn::Set(du, 0x3f000000u));
    const auto is_small = hn::Lt(v.v, hn::Set(k_floats, 0x1p-14f));
    return {hn::ConvertTo(k_floats, hn::BitCast(di, hn::IfThenElse(hn::RebindMask(du, is_small), small, normal)))};
}

#include "texture/block/bc6h_search-inl.h"

void bc6h_encode_here(const float* texels, int count, EncodingQuality quality, std::uint8_t* blocks) {
    const Effort effort = effort_of(quality);
    for (int i = 0, lanes = lane_count(); i < count; i += lanes)
        encode_lanes(texels + 48 * i, std::min(lanes, count - i), effort, blocks + k_block_bytes * i);
}

}  // namespace HWY_NAMESPACE
}  // namespace domelight::simd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(bc6h_encode_here);

void bc6h_encode(const float* texels, int count, EncodingQuality quality, std::uint8_t* blocks) {
    HWY_DYNAMIC_DISPATCH(bc6h_encode_here)(texels, count, quality, blocks);
}

}  // namespace domelight::simd
#endif
