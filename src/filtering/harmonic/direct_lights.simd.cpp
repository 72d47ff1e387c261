#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filtering/harmonic/direct_lights.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

#include "filtering/harmonic/direct_lights.h"

#include <algorithm>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

/// The closed form from the chord: 1 - c keeps its digits for the narrowest lobe.
struct GgxKernel {
    const DirectKernel& kernel;
    HWY_INLINE V operator()(V half_chord2) const {
        const D d;
        const V one = hn::Set(d, 1.f), c = hn::Sub(one, half_chord2);
        const V q = hn::MulAdd(hn::Set(d, kernel.alpha2), hn::Add(one, c), half_chord2);
        return hn::Div(hn::Mul(hn::Set(d, kernel.scale), hn::Max(c, hn::Zero(d))), hn::Mul(q, q));
    }
};

struct TableKernel {
    const DirectKernel& kernel;
    HWY_INLINE V operator()(V half_chord2) const {
        const D d;
        const V c = hn::Max(hn::Sub(hn::Set(d, 1.f), half_chord2), hn::Set(d, -1.f));
        const V at = hn::Mul(hn::Acos(d, c), hn::Set(d, float(kernel.table.steps / std::numbers::pi)));
        const auto index = hn::ConvertTo(hn::RebindToSigned<D>(), at);
        const V low = hn::GatherIndex(d, kernel.table.values, index),
                high = hn::GatherIndex(d, kernel.table.values + 1, index);
        return hn::MulAdd(hn::Sub(at, hn::ConvertTo(d, index)), hn::Sub(high, low), low);
    }
};

template <typename Kernel>
HWY_INLINE void add_lights(const LightNode* nodes, int node_count, const PointSet& points, const Kernel& kernel,
                           const float* x, const float* y, const float* z, int count, float* rgb) {
    const D d;
    const int lanes = int(hn::Lanes(d));
    constexpr int block_size = 16;  // the same on every instruction set, so that all choose the same nodes
    for (int i = 0; i < count; i += block_size) {
        const int n = std::min(block_size, count - i);
        alignas(64) float block[6][block_size] = {};
        for (int k = 0; k < block_size; ++k) {
            const int from = i + std::min(k, n - 1);
            block[0][k] = x[from], block[1][k] = y[from], block[2][k] = z[from];
        }
        for (int n_at = 0; n_at < node_count;) {
            const LightNode& node = nodes[n_at];
            if (node.cos_far <= 1) {
                float nearest = -1, farthest = 1;
                for (int lane = 0; lane < block_size; lane += lanes) {
                    const V cosine = hn::MulAdd(hn::Load(d, block[0] + lane), hn::Set(d, node.x),
                                                hn::MulAdd(hn::Load(d, block[1] + lane), hn::Set(d, node.y),
                                                           hn::Mul(hn::Load(d, block[2] + lane), hn::Set(d, node.z))));
                    nearest = std::max(nearest, hn::GetLane(hn::MaxOfLanes(d, cosine)));
                    farthest = std::min(farthest, hn::GetLane(hn::MinOfLanes(d, cosine)));
                }
                const bool on_horizon = farthest < node.radius && nearest > -node.radius;
                if (on_horizon || nearest >= node.cos_far) {
                    ++n_at;
                    continue;
                }
            }
            n_at = node.skip;
            const int begin = node.first, end = node.first + node.count;
            for (int lane = 0; lane < block_size; lane += lanes) {
                const V vx = hn::Load(d, block[0] + lane), vy = hn::Load(d, block[1] + lane),
                        vz = hn::Load(d, block[2] + lane);
                // Each node is summed by itself first: thousands of small terms added to one large sum would lose their
                // last digits.
                V r = hn::Zero(d), g = hn::Zero(d), b = hn::Zero(d);
                for (int p = begin; p < end; ++p) {
                    const V dx = hn::Sub(vx, hn::Set(d, points.x[p])), dy = hn::Sub(vy, hn::Set(d, points.y[p])),
                            dz = hn::Sub(vz, hn::Set(d, points.z[p]));
                    const V half_chord2 =
                        hn::Mul(hn::Set(d, 0.5f), hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
                    const V f = kernel(half_chord2);
                    r = hn::MulAdd(f, hn::Set(d, points.r[p]), r);
                    g = hn::MulAdd(f, hn::Set(d, points.g[p]), g);
                    b = hn::MulAdd(f, hn::Set(d, points.b[p]), b);
                }
                hn::Store(hn::Add(hn::Load(d, block[3] + lane), r), d, block[3] + lane);
                hn::Store(hn::Add(hn::Load(d, block[4] + lane), g), d, block[4] + lane);
                hn::Store(hn::Add(hn::Load(d, block[5] + lane), b), d, block[5] + lane);
            }
        }
        for (int k = 0; k < n; ++k)
            for (int c = 0; c < 3; ++c) rgb[3 * (i + k) + c] += block[3 + c][k];
    }
}

void add_direct_lights(const LightNode* nodes, int node_count, const PointSet& points, const DirectKernel& kernel,
                       const float* x, const float* y, const float* z, int count, float* rgb) {
    if (kernel.table.values)
        add_lights(nodes, node_count, points, TableKernel{kernel}, x, y, z, count, rgb);
    else
        add_lights(nodes, node_count, points, GgxKernel{kernel}, x, y, z, count, rgb);
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(add_direct_lights);

void add_direct_lights(const LightNode* nodes, int node_count, const PointSet& points, const DirectKernel& kernel,
                       const float* x, const float* y, const float* z, int count, float* rgb) {
    HWY_DYNAMIC_DISPATCH(add_direct_lights)(nodes, node_count, points, kernel, x, y, z, count, rgb);
}

}  // namespace domelight::simd
#endif
