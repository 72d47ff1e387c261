#include "render/shading/stretched_lobe.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

constexpr int k_terms = k_stretched_cosines * k_stretched_roughnesses;

std::array<double, k_terms> monomials(double NdotV, double roughness) {
    std::array<double, k_terms> m;
    double cosine = 1;
    for (int i = 0; i < k_stretched_cosines; ++i, cosine *= std::sqrt(NdotV)) {
        double term = cosine;
        for (int j = 0; j < k_stretched_roughnesses; ++j, term *= roughness)
            m[std::size_t(i * k_stretched_roughnesses + j)] = term;
    }
    return m;
}

/// The least roughness of a lookup: with the mirror level blended in, a bright sun would appear as a row of suns. Up to
/// roughness 0.1 the spacing of the row is smaller than the sun; from 0.2 on, the least roughness is that of the first
/// filtered level of the generic chain, 1/6.
double least_roughness(double roughness) {
    return std::clamp(10 * roughness - 1, 0.0, 1.0) / 6;
}

/// max(x, least) with a rounded corner.
double smooth_max(double x, double least) {
    const double above = x - least, corner = 0.05 * least;
    return least + 0.5 * (above + std::sqrt(above * above + corner * corner));
}

/// The degree, [0, 1], to which the lookups become that of split-sum. It is 1 for smooth surfaces seen from straight
/// above, where split-sum is as good as the chain allows and better than the fit.
double settled(double NdotV, double roughness) {
    const double above = std::clamp(10 * NdotV - 9, 0.0, 1.0);
    return above * above * std::clamp(4 - 10 * roughness, 0.0, 1.0);
}

}  // namespace

std::array<StretchedTap, k_stretched_taps> stretched_taps(double NdotV, double roughness) {
    NdotV = std::clamp(NdotV, 0.0, 1.0);
    roughness = std::clamp(roughness, 0.0, 1.0);
    const auto m = monomials(NdotV, roughness);
    // In the plane of incidence the lobe is 2 alpha wide, whatever the angle; towards the normal it becomes round.
    const double width = 2 * roughness * roughness * std::sqrt(1 - NdotV * NdotV);
    constexpr double most_tilt = 1.7;
    std::array<StretchedTap, k_stretched_taps> taps;
    double scale = 0, bias = 0;
    for (std::size_t t = 0; t < taps.size(); ++t) {
        const auto polynomial = [&](int which) {
            double sum = 0;
            for (std::size_t k = 0; k < m.size(); ++k) sum += double(k_stretched_fit[t][which][k]) * m[k];
            return sum;
        };
        taps[t].tilt = std::clamp(width * polynomial(0), -most_tilt, most_tilt);
        const double fitted = std::min(smooth_max(roughness * polynomial(1), least_roughness(roughness)), 1.0);
        taps[t].roughness = fitted + (roughness - fitted) * settled(NdotV, roughness);
        scale += taps[t].scale = std::exp(polynomial(2));
        bias += taps[t].bias = std::exp(polynomial(3));
    }
    for (StretchedTap& t : taps) t.scale /= scale, t.bias /= bias;
    return taps;
}

}  // namespace domelight
