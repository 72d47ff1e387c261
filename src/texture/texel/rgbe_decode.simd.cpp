#include "texture/texel/rgbe_decode.h"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texture/texel/rgbe_decode.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void rgbe_row(const std::uint8_t* planes, std::size_t plane_stride, int width, const std::array<float, 3>& scale,
              float* out) {
    const hn::ScalableTag<float> df;
    const hn::RebindToUnsigned<decltype(df)> du;
    const hn::Rebind<std::uint8_t, decltype(df)> db;
    const hn::RebindToSigned<decltype(df)> di;
    const int lanes = int(hn::Lanes(df));
    const auto one = hn::Set(du, 1u);
    const auto scale_r = hn::Set(df, scale[0] * 0x1p-8f), scale_g = hn::Set(df, scale[1] * 0x1p-8f),
               scale_b = hn::Set(df, scale[2] * 0x1p-8f);
    int x = 0;
    for (; x + lanes <= width; x += lanes) {
        const auto load = [&](int c) { return hn::PromoteTo(du, hn::LoadU(db, planes + c * plane_stride + x)); };
        // 2^(e - 128): the exponent's field is e - 1.
        const auto power = hn::BitCast(df, hn::ShiftLeft<23>(hn::Sub(hn::Max(load(3), one), one)));
        const auto channel = [&](int c, auto s) {
            return hn::Mul(hn::Mul(hn::ConvertTo(df, hn::BitCast(di, load(c))), s), power);
        };
        hn::StoreInterleaved3(channel(0, scale_r), channel(1, scale_g), channel(2, scale_b), df, out + 3 * x);
    }
    rgbe_to_float_scalar(planes + x, plane_stride, width - x, scale, out + 3 * x);
}

}  // namespace HWY_NAMESPACE
}  // namespace domelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight {

HWY_EXPORT(rgbe_row);

void rgbe_to_float(const std::uint8_t* planes, std::size_t plane_stride, int width, const std::array<float, 3>& scale,
                   float* out) {
    HWY_DYNAMIC_DISPATCH(rgbe_row)(planes, plane_stride, width, scale, out);
}

void rgbe_to_float_scalar(const std::uint8_t* planes, std::size_t plane_stride, int width,
                          const std::array<float, 3>& scale, float* out) {
    for (int x = 0; x < width; ++x) {
        const std::uint32_t exponent = std::max<std::uint32_t>(planes[3 * plane_stride + x], 1);
        const float power = std::bit_cast<float>((exponent - 1) << 23);  // 2^(e - 128)
        for (int c = 0; c < 3; ++c) out[3 * x + c] = float(planes[c * plane_stride + x]) * (scale[c] * 0x1p-8f) * power;
    }
}

}  // namespace domelight
#endif
