#include "render/surface/lobe_albedo.h"

#include "domelight/filtering/brdf/brdf_table.h"

#include <algorithm>
#include <cmath>

namespace domelight {

TableAlbedo table_albedo(float NdotV, float roughness) {
    const ImageF& table = brdf_table_default();
    const int n = table.width();
    // Linear between texel centres, and extrapolated linearly beyond the outermost ones: at roughness 1 clamping would
    // be off by 1 %.
    const float x = NdotV * float(n) - 0.5f, y = roughness * float(n) - 0.5f;
    const int x0 = std::clamp(int(x), 0, n - 2), y0 = std::clamp(int(y), 0, n - 2);
    const float a = x - float(x0), b = y - float(y0);
    const auto channel = [&](int c) {
        const auto at = [&](int i, int j) { return table.at(i, j)[c]; };
        const float upper = at(x0, y0) + a * (at(x0 + 1, y0) - at(x0, y0)),
                    lower = at(x0, y0 + 1) + a * (at(x0 + 1, y0 + 1) - at(x0, y0 + 1));
        return upper + b * (lower - upper);
    };
    return {channel(0), channel(1), std::max(0.f, channel(2))};
}

InterfaceAlbedo interface_albedo(const InterfaceLobe& lobe, const Vec3f& V, UnitPoint shift) {
    // A Fibonacci lattice.
    constexpr std::uint32_t k_points = 89, k_step = 55;
    const EllipticGgx& ggx = lobe.ggx;
    const float root_V = ggx.root(V);
    InterfaceAlbedo sum;
    for (std::uint32_t i = 0; i < k_points; ++i) {
        constexpr std::uint64_t k_turn = std::uint64_t(1) << 32;
        const UnitPoint u{shift.x + std::uint32_t(k_turn * i / k_points),
                          shift.y + std::uint32_t(k_turn * (i * k_step % k_points) / k_points)};
        const Vec3f H = normalize(ggx.draw(V, u, 1));
        const float VdotH = dot(V, H);
        if (!(VdotH > 0)) continue;
        // Visible normals, each with weight G2 / G1(V), height-correlated: L.z (V.z + root V) / (V.z root L + L.z root
        // V).
        const Vec3f L = H * (2 * VdotH) - V;
        const float mirrored = L.z > 0 ? L.z * (V.z + root_V) / (V.z * ggx.root(L) + L.z * root_V) : 0;
        if (lobe.total(VdotH)) {
            sum.total += mirrored;
            continue;
        }
        float clear = mirrored;
        if (!lobe.thin) {
            const Vec3f T = (H * (VdotH - std::sqrt(lobe.eta * lobe.eta - 1 + VdotH * VdotH)) - V) / lobe.eta;
            clear = T.z < 0 ? ggx.masking(T) : 0;
        }
        const float fresnel = lobe.weight(VdotH);
        sum.reflect_scale += (1 - fresnel) * mirrored;
        sum.reflect_bias += fresnel * mirrored;
        sum.clear += clear;
        sum.clear_scale += (1 - fresnel) * clear;
        sum.clear_bias += fresnel * clear;
    }
    for (float* part :
         {&sum.total, &sum.reflect_scale, &sum.reflect_bias, &sum.clear, &sum.clear_scale, &sum.clear_bias})
        *part *= 1.f / k_points;
    return sum;
}

}  // namespace domelight
