#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filtering/harmonic/zonal_sum.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
#include "filtering/harmonic/zonal_sum.h"
#include <algorithm>
#include <numbers>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void add_zonal_sum(const PointSet& points, const ZonalTable& table, const float* x, const float* y, const float* z,
                   int count, float* rgb) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToSigned<decltype(d)> di;
    const int lanes = int(hn::Lanes(d));
    const auto scale = hn::Set(d, float(table.steps / std::numbers::pi));
    const auto one = hn::Set(d, 1.f), minus_one = hn::Set(d, -1.f);
    for (int i = 0; i < count; i += lanes) {
        const int n = std::min(lanes, count - i);
        alignas(64) float block[3][16] = {};
        for (int k = 0; k < n; ++k) block[0][k] = x[i + k], block[1][k] = y[i + k], block[2][k] = z[i + k];
        const auto vx = hn::Load(d, block[0]), vy = hn::Load(d, block[1]), vz = hn::Load(d, block[2]);
        auto r = hn::Zero(d), g = r, b = r;
        for (int p = 0; p < points.count; ++p) {
            auto c = hn::Mul(vx, hn::Set(d, points.x[p]));
            c = hn::MulAdd(vy, hn::Set(d, points.y[p]), c);
            c = hn::MulAdd(vz, hn::Set(d, points.z[p]), c);
            c = hn::Min(hn::Max(c, minus_one), one);
            const auto at = hn::Mul(hn::Acos(d, c), scale);
            const auto index = hn::ConvertTo(di, at);
            const auto t = hn::Sub(at, hn::ConvertTo(d, index));
            const auto low = hn::GatherIndex(d, table.values, index),
                       high = hn::GatherIndex(d, table.values + 1, index);
            const auto f = hn::MulAdd(t, hn::Sub(high, low), low);
            r = hn::MulAdd(f, hn::Set(d, points.r[p]), r);
            g = hn::MulAdd(f, hn::Set(d, points.g[p]), g);
            b = hn::MulAdd(f, hn::Set(d, points.b[p]), b);
        }
        hn::Store(r, d, block[0]);
        hn::Store(g, d, block[1]);
        hn::Store(b, d, block[2]);
        for (int k = 0; k < n; ++k)
            for (int c = 0; c < 3; ++c) rgb[3 * (i + k) + c] += block[c][k];
    }
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(add_zonal_sum);

void add_zonal_sum(const PointSet& points, const ZonalTable& table, const float* x, const float* y, const float* z,
                   int count, float* rgb) {
    HWY_DYNAMIC_DISPATCH(add_zonal_sum)(points, table, x, y, z, count, rgb);
}

}  // namespace domelight::simd
#endif
