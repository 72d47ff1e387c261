#include "domelight/filtering/brdf/brdf_table.h"

#include "domelight/base/parallel.h"
#include "domelight/sampling/microfacet.h"

#include "filtering/brdf/brdf_embedded.h"
#include "filtering/brdf/brdf_quadrature.h"

#include <cassert>
#include <cmath>

namespace domelight {
namespace {

/// Fills a table texel by texel: `terms(NdotV, alpha)` gives (scale, bias, charlie).
template <typename Terms>
ImageF fill(int size, int threads, const Terms& terms) {
    assert(size >= 1);
    ImageF table(size, size, 3);
    parallel_for(size, threads, [&](int y) {
        const double roughness = (y + 0.5) / size;
        for (int x = 0; x < size; ++x) {
            const Vec3d value = terms((x + 0.5) / size, roughness * roughness);
            float* p = table.at(x, y);
            p[0] = float(value.x), p[1] = float(value.y), p[2] = float(value.z);
        }
    });
    return table;
}

/// Karis 2013, IntegrateBRDF: half vectors are drawn from D NdotH, so the weight of each sample is G VdotH / (NdotH
/// NdotV).
BrdfTerms montecarlo_terms(double NdotV, double alpha, BrdfG g, const PointSet& points) {
    const double s_v = std::sqrt((1 - NdotV) * (1 + NdotV)), a2 = alpha * alpha;
    BrdfTerms sum;
    for (int i = 0; i < points.count; ++i) {
        const UnitPoint point = points[i];
        const double phi = 2 * k_pi * unit_double(point.x);
        const PolarSquares h = ggx_half_angle(unit_double(point.y), a2);
        const double c_h = std::sqrt(h.cos2), s_h = std::sqrt(h.sin2);
        const double VdotH = NdotV * c_h + s_v * s_h * std::cos(phi), NdotL = 2 * VdotH * c_h - NdotV;
        if (NdotL <= 0) continue;
        const double f = 4 * brdf_visibility(NdotL, NdotV, alpha, g) * NdotL * VdotH / c_h;
        const double fresnel = schlick_weight(VdotH);
        sum.scale += (1 - fresnel) * f;
        sum.bias += fresnel * f;
    }
    return {sum.scale / points.count, sum.bias / points.count};
}

/// The sheen's albedo from half vectors uniform over the hemisphere, as in the Khronos tool.
double montecarlo_sheen(double NdotV, double alpha, const PointSet& points) {
    const double s_v = std::sqrt((1 - NdotV) * (1 + NdotV));
    double sum = 0;
    for (int i = 0; i < points.count; ++i) {
        const UnitPoint point = points[i];
        const double c_h = 1 - unit_double(point.y), s2_h = (1 - c_h) * (1 + c_h),
                     phi = 2 * k_pi * unit_double(point.x);
        const double VdotH = NdotV * c_h + s_v * std::sqrt(s2_h) * std::cos(phi), NdotL = 2 * VdotH * c_h - NdotV;
        if (NdotL <= 0) continue;
        sum +=
            charlie_d(s2_h, alpha) * NdotL * VdotH / (NdotL + NdotV - NdotL * NdotV);  // 4 VdotH dh = dl, V's own 1/4
    }
    return sum * 2 * k_pi / points.count;
}

}  // namespace

ImageF integrate_brdf_table(int size, BrdfG g, bool sheen, int threads) {
    return fill(size, threads, [&](double NdotV, double alpha) {
        const BrdfTerms terms = integrate_brdf(NdotV, alpha, g);
        return Vec3d{terms.scale, terms.bias, sheen ? integrate_sheen(NdotV, alpha) : 0};
    });
}

ImageF brdf_table(const BrdfTableOptions& options) {
    const bool same_sheen = options.size == k_brdf_embedded_size;  // the sheen lobe does not depend on G
    if (same_sheen && options.g == BrdfG::correlated) return brdf_table_default();
    ImageF table = integrate_brdf_table(options.size, options.g, !same_sheen, options.threads);
    if (same_sheen) {
        const ImageF& embedded = brdf_table_default();
        for (std::size_t i = 2; i < table.pixels().size(); i += 3) table.pixels()[i] = embedded.pixels()[i];
    }
    return table;
}

ImageF brdf_table_multiscatter(ImageView<const float> table) {
    assert(table.channels == 3);
    ImageF out(table.width, table.height, 3);
    for (int y = 0; y < table.height; ++y)
        for (int x = 0; x < table.width; ++x) {
            const float* in = table.at(x, y);
            float* p = out.at(x, y);
            p[0] = in[1], p[1] = in[0] + in[1], p[2] = in[2];
        }
    return out;
}

ImageF brdf_table_montecarlo(const BrdfTableOptions& options, const PointSet& points) {
    assert(points.count >= 1);
    return fill(options.size, options.threads, [&](double NdotV, double alpha) {
        const BrdfTerms terms = montecarlo_terms(NdotV, alpha, options.g, points);
        return Vec3d{terms.scale, terms.bias, montecarlo_sheen(NdotV, alpha, points)};
    });
}

const ImageF& brdf_table_default() {
    static const ImageF table = embedded_brdf_table();
    return table;
}

}  // namespace domelight
