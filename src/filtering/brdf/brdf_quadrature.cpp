#include "filtering/brdf/brdf_quadrature.h"

#include "domelight/sampling/microfacet.h"

#include "base/gauss_legendre.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace domelight {
namespace {

/// A view direction and the lobe: everything that does not depend on the node.
struct View {
    double c, s;  ///< cos and sin of theta_v
    double alpha;
    BrdfG g;
};

/// Integral over the azimuth, 0 to the end of NdotL > 0 and both signs, of 4 V NdotL VdotH / NdotH times 1 - Fc and Fc.
BrdfTerms integrate_azimuth(const View& view, double c_h, double s_h, const GaussLegendre& rule) {
    const double flat = view.s * s_h;
    const double least = view.c / (2 * c_h) - view.c * c_h;  // VdotH - c_v c_h where NdotL = 0
    const double end = least <= -flat ? k_pi : least >= flat ? 0 : std::acos(least / flat);
    BrdfTerms sum;
    for (std::size_t j = 0; j < rule.x.size(); ++j) {
        const double phi = end * (1 + rule.x[j]) / 2, VdotH = view.c * c_h + flat * std::cos(phi);
        const double NdotL = 2 * VdotH * c_h - view.c;
        if (NdotL <= 0) continue;  // rounding at the end of the range
        const double f = 4 * brdf_visibility(NdotL, view.c, view.alpha, view.g) * NdotL * VdotH / c_h;
        const double fresnel = schlick_weight(VdotH), weight = rule.w[j] * end * f;  // end / 2, twice
        sum.scale += weight * (1 - fresnel);
        sum.bias += weight * fresnel;
    }
    return sum;
}

/// Adds the polar angles za..zb (in z) to `sum`.
void integrate_piece(const View& view, double za, double zb, const BrdfNodes& nodes, BrdfTerms& sum) {
    const GaussLegendre &polar = gauss_legendre(nodes.polar), &azimuth = gauss_legendre(nodes.azimuth);
    for (int i = 0; i < nodes.polar; ++i) {
        const double x = (1 + polar.x[i]) / 2, z = za + (zb - za) * x * x * (3 - 2 * x);
        const double dz = (zb - za) * 6 * x * (1 - x) * polar.w[i] / 2;
        const double t = view.alpha * std::tan(z), c_h = 1 / std::sqrt(1 + t * t);
        const BrdfTerms ring = integrate_azimuth(view, c_h, t * c_h, azimuth);
        const double weight = std::sin(z) * std::cos(z) * dz / k_pi;
        sum.scale += weight * ring.scale;
        sum.bias += weight * ring.bias;
    }
}

}  // namespace

double brdf_visibility(double NdotL, double NdotV, double alpha, BrdfG g) {
    switch (g) {
        case BrdfG::correlated:
            return ggx_visibility(NdotL, NdotV, alpha);
        case BrdfG::smith:
            // G1 G1 / (4 NdotL NdotV), each G1 by Walter et al. 2007, eq. 34
            return 1 / ((NdotL + ggx_smith_root(NdotL, alpha)) * (NdotV + ggx_smith_root(NdotV, alpha)));
        case BrdfG::karis: {
            const double k = alpha / 2;  // Karis 2013, eq. 4 for image-based lighting
            return 0.25 / ((NdotL * (1 - k) + k) * (NdotV * (1 - k) + k));
        }
    }
    return 0;
}

BrdfTerms integrate_brdf(double NdotV, double alpha, BrdfG g, BrdfNodes nodes) {
    const View view{NdotV, std::sqrt((1 - NdotV) * (1 + NdotV)), alpha, g};
    const double theta = std::atan2(view.s, view.c);
    const auto z_of = [&](double theta_h) { return std::atan(std::tan(theta_h) / alpha); };
    const double all = z_of((k_pi / 2 - theta) / 2), none = z_of((k_pi / 2 + theta) / 2);
    BrdfTerms sum;
    integrate_piece(view, 0, all, nodes, sum);
    integrate_piece(view, all, none, nodes, sum);
    return sum;
}

double integrate_sheen(double NdotV, double alpha, int nodes) {
    const GaussLegendre& rule = gauss_legendre(nodes);
    const double s_v = std::sqrt((1 - NdotV) * (1 + NdotV)), half_power = 0.5 / alpha;
    // x in [0, 1] to scale (e^(x log(1 + end / scale)) - 1) in [0, end]
    const auto stretch = [&](double end, double scale, double x, double& slope) {
        const double rate = std::log1p(end / scale), e = std::exp(rate * x);
        slope = scale * rate * e;
        return scale * (e - 1);
    };
    double sum = 0;
    for (int i = 0; i < nodes; ++i) {
        double dmu;
        const double NdotL = stretch(1, NdotV, (1 + rule.x[i]) / 2, dmu),
                     s_l = std::sqrt(std::max(0.0, (1 - NdotL) * (1 + NdotL)));
        double ring = 0;
        for (int j = 0; j < nodes; ++j) {
            double dphi;
            const double from_mirror = stretch(k_pi, NdotV, (1 + rule.x[j]) / 2, dphi);
            // sin^2 theta_h = 1 - (NdotL + NdotV)^2 / (2 (1 + v.l)) = (|s_l - s_v|^2 in the plane) / |v + l|^2, without
            // cancellation
            const double b = std::sin(from_mirror / 2);
            const double across = (s_l - s_v) * (s_l - s_v) + 4 * s_l * s_v * b * b, up = NdotL + NdotV;
            ring += rule.w[j] / 2 * dphi * std::pow(across / (across + up * up), half_power);
        }
        sum += rule.w[i] / 2 * dmu * sheen_visibility(NdotL, NdotV) * NdotL * 2 * ring;
    }
    return sum * (2 + 1 / alpha) / (2 * k_pi);
}

}  // namespace domelight
