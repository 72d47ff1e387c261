#include "preview/agx_display.h"

#include "preview/agx.h"

#include <bit>
#include <cmath>

namespace domelight {

AgxDisplay::AgxDisplay(float exposure) : exposure_(exposure) {
    const Vec3f axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int c = 0; c < 3; ++c) {
        const Vec3f in = agx_inset(axes[c]) * exposure, out = agx_outset(axes[c], true);
        inset_[c] = Texel4::of(in.x, in.y, in.z);
        column_[c] = Texel4::of(out.x, out.y, out.z);
    }
    const std::int32_t last = (std::bit_cast<std::int32_t>(k_most) - k_first) >> k_shift;
    for (std::int32_t i = 0; i <= last; ++i)  // at the middle of what has the same upper bits
        curve_.push_back(agx_curve(std::bit_cast<float>(k_first + (i << k_shift) + (1 << (k_shift - 1))), true));
    for (int i = 0; i < k_codes; ++i)
        codes_.push_back(to_byte(srgb_encode(std::pow(float(i) / float(k_codes - 1), 2.2f))));
}

Texel4 AgxDisplay::primaries(const Texel4& radiance) const {
    using V = Texel4::Vector;
    const V zero = Texel4::all(0).v, most = Texel4::all(1e30f).v;
    V v = radiance.v;
    v = v >= zero ? v : zero;  // also takes NaN to 0
    v = v > most ? most : v;
    return {v[0] * inset_[0].v + v[1] * inset_[1].v + v[2] * inset_[2].v};
}

}  // namespace domelight
