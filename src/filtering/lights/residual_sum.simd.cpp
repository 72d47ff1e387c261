#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filtering/lights/residual_sum.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "filtering/lights/residual_sum.h"
// clang-format on

#include <algorithm>
#include <cmath>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int k_group = 16;
using D = hn::CappedTag<float, k_group>;
using V = hn::Vec<D>;

HWY_INLINE V look_up(V at, const float* table, int steps) {
    const D d;
    const hn::RebindToSigned<D> di;
    at = hn::Min(hn::Max(at, hn::Zero(d)), hn::Set(d, float(steps)));
    const auto index = hn::Min(hn::ConvertTo(di, at), hn::Set(di, steps - 1));
    const V low = hn::GatherIndex(d, table, index), high = hn::GatherIndex(d, table + 1, index);
    return hn::MulAdd(hn::Sub(at, hn::ConvertTo(d, index)), hn::Sub(high, low), low);
}

HWY_INLINE V cosine(const float* x, const float* y, const float* z, V dx, V dy, V dz) {
    const D d;
    return hn::MulAdd(hn::LoadU(d, x), dx, hn::MulAdd(hn::LoadU(d, y), dy, hn::Mul(hn::LoadU(d, z), dz)));
}

struct Sums {
    V r, g, b;
};

/// Adds the 16 lights from `first` on.
HWY_INLINE void add_group(const PointSet& lights, int first, const ResidualTable& table, bool ring, bool axis, V dx,
                          V dy, V dz, Sums& sums) {
    const D d;
    for (int p = first; p < first + k_group; p += int(hn::Lanes(d))) {
        V f = hn::Zero(d);
        if (ring) {
            const V c = cosine(lights.x + p, lights.y + p, lights.z + p, dx, dy, dz);
            const float scale = float(table.ring_steps) / (2 * table.half_width);
            f = look_up(hn::MulAdd(c, hn::Set(d, scale), hn::Set(d, 0.5f * float(table.ring_steps))), table.ring,
                        table.ring_steps);
        }
        if (axis) {
            // From differences: 2 - 2 c would lose the digits of a short chord.
            const V x = hn::Sub(dx, hn::LoadU(d, lights.x + p)), y = hn::Sub(dy, hn::LoadU(d, lights.y + p)),
                    z = hn::Sub(dz, hn::LoadU(d, lights.z + p));
            const V chord = hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))));
            f = hn::Add(f, look_up(hn::Mul(chord, hn::Set(d, float(table.axis_steps) / table.extent)), table.axis,
                                   table.axis_steps));
        }
        sums.r = hn::MulAdd(f, hn::LoadU(d, lights.r + p), sums.r);
        sums.g = hn::MulAdd(f, hn::LoadU(d, lights.g + p), sums.g);
        sums.b = hn::MulAdd(f, hn::LoadU(d, lights.b + p), sums.b);
    }
}

/// The groups that may matter to one of a few neighbouring directions, one after the other.
class Candidates {
  public:
    explicit Candidates(int most) : x_(most), y_(most), z_(most), ring_(most), axis_(most), group_(most) {}

    /// Of the directions within the chord `radius` of a centre.
    HWY_INLINE void collect(const ResidualGroups& groups, float cx, float cy, float cz, float radius) {
        const D d;
        const int lanes = int(hn::Lanes(d));
        const V vx = hn::Set(d, cx), vy = hn::Set(d, cy), vz = hn::Set(d, cz), vr = hn::Set(d, radius);
        count_ = 0;
        for (int g = 0; g < groups.count; g += lanes) {
            const V c = cosine(groups.x + g, groups.y + g, groups.z + g, vx, vy, vz);
            const V ring = hn::LoadU(d, groups.ring_limit + g), axis = hn::LoadU(d, groups.axis_limit + g);
            // A limit of never (-1 and 2) stays one.
            const auto on_ring = hn::And(hn::Lt(hn::Sub(hn::Abs(c), vr), ring), hn::Gt(ring, hn::Zero(d))),
                       on_axis = hn::And(hn::Gt(hn::Add(c, vr), axis), hn::Le(axis, hn::Set(d, 1.f)));
            const auto either = hn::Or(on_ring, on_axis);
            if (hn::AllFalse(d, either)) continue;
            alignas(64) float matters[k_group];
            hn::Store(hn::IfThenElseZero(either, hn::Set(d, 1.f)), d, matters);
            for (int k = 0; k < lanes; ++k)
                if (matters[k] > 0) add(groups, g + k);
        }
        while (count_ % lanes) x_[count_] = y_[count_] = z_[count_] = 0, ring_[count_] = -1, axis_[count_++] = 2;
    }

    HWY_INLINE bool add_to(const ResidualGroups& groups, const ResidualTable& table, V dx, V dy, V dz,
                           Sums& sums) const {
        const D d;
        const int lanes = int(hn::Lanes(d));
        bool any = false;
        for (int i = 0; i < count_; i += lanes) {
            const V c = cosine(x_.data() + i, y_.data() + i, z_.data() + i, dx, dy, dz);
            const auto on_ring = hn::Lt(hn::Abs(c), hn::LoadU(d, ring_.data() + i)),
                       on_axis = hn::Gt(c, hn::LoadU(d, axis_.data() + i));
            if (hn::AllFalse(d, hn::Or(on_ring, on_axis))) continue;
            any = true;
            alignas(64) float ring[k_group], axis[k_group];
            hn::Store(hn::IfThenElseZero(on_ring, hn::Set(d, 1.f)), d, ring);
            hn::Store(hn::IfThenElseZero(on_axis, hn::Set(d, 1.f)), d, axis);
            for (int k = 0; k < lanes; ++k)
                if (ring[k] + axis[k] > 0)
                    add_group(groups.lights, group_[i + k] * k_group, table, ring[k] > 0, axis[k] > 0, dx, dy, dz,
                              sums);
        }
        return any;
    }

  private:
    HWY_INLINE void add(const ResidualGroups& groups, int g) {
        x_[count_] = groups.x[g], y_[count_] = groups.y[g], z_[count_] = groups.z[g];
        ring_[count_] = groups.ring_limit[g], axis_[count_] = groups.axis_limit[g], group_[count_++] = g;
    }

    int count_ = 0;
    std::vector<float> x_, y_, z_, ring_, axis_;
    std::vector<int> group_;
};

void add_residual_sums(const ResidualGroups& groups, const ResidualTable& table, const float* x, const float* y,
                       const float* z, int count, float* rgb) {
    const D d;
    constexpr int block = 32;
    Candidates candidates(groups.count);
    for (int from = 0; from < count; from += block) {
        const int end = std::min(from + block, count), middle = (from + end) / 2;
        float radius = 0;
        for (int i = from; i < end; ++i) {
            const float dx = x[i] - x[middle], dy = y[i] - y[middle], dz = z[i] - z[middle];
            radius = std::max(radius, dx * dx + dy * dy + dz * dz);
        }
        candidates.collect(groups, x[middle], y[middle], z[middle], std::sqrt(radius) * 1.0001f + 1e-6f);
        for (int i = from; i < end; ++i) {
            Sums sums{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
            if (!candidates.add_to(groups, table, hn::Set(d, x[i]), hn::Set(d, y[i]), hn::Set(d, z[i]), sums)) continue;
            rgb[3 * i] += hn::GetLane(hn::SumOfLanes(d, sums.r));
            rgb[3 * i + 1] += hn::GetLane(hn::SumOfLanes(d, sums.g));
            rgb[3 * i + 2] += hn::GetLane(hn::SumOfLanes(d, sums.b));
        }
    }
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(add_residual_sums);

void add_residual_sums(const ResidualGroups& groups, const ResidualTable& table, const float* x, const float* y,
                       const float* z, int count, float* rgb) {
    HWY_DYNAMIC_DISPATCH(add_residual_sums)(groups, table, x, y, z, count, rgb);
}

}  // namespace domelight::simd
#endif
