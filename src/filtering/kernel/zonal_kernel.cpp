#include "domelight/filtering/kernel/zonal_kernel.h"

#include "filtering/kernel/kernel_density.h"

#include <cassert>

namespace domelight {
namespace {

/// The exponent of the lobe: charlie (1 - c)^p with p = 1 / (2 alpha), phong c^p.
double lobe_power(const ZonalKernel& kernel) {
    switch (kernel.lobe) {
        case Lobe::charlie:
            return 0.5 / std::max(kernel.width, k_least_alpha);
        case Lobe::phong_brdf:
            return kernel.width + 1;
        case Lobe::phong_plain:
            return kernel.width;
        case Lobe::ggx:
            break;
    }
    return 0;
}

/// ∫_0^1 c / (1 - w c)^2 dc = (w / (1 - w) + log(1 - w)) / w^2.
double ggx_integral(double w, double one_minus_w) {
    if (w > 0.1) return (w / one_minus_w + std::log(one_minus_w)) / (w * w);
    // The closed form cancels as w -> 0: sum_k (k + 1) / (k + 2) w^k.
    double sum = 0, power = 1;
    for (int k = 0; k < 24; ++k, power *= w) sum += (k + 1.0) / (k + 2.0) * power;
    return sum;
}

/// P_l(0) for l = 0..count - 1.
std::vector<double> legendre_at_zero(int count) {
    std::vector<double> p(count, 0.0);
    for (int l = 0; l < count; l += 2) p[l] = l == 0 ? 1 : -(l - 1.0) / l * p[l - 2];
    return p;
}

/// Solves (2l + 1) x_l - w ((l + 1) x_{l+1} + l x_{l-1}) = r_l, l = 0..size - 1, with x_size = 0.
///
/// The matrix is diagonally dominant, but only barely so for a narrow lobe (w -> 1). So each pivot is stored as w (l +
/// 1) plus the row's excess over its off-diagonal entries. Elimination only adds to this excess, so there is no
/// subtraction, and the precision is full for every w (the idea of Grassmann, Taksar and Heyman 1985).
std::vector<double> solve_legendre_system(double w, double one_minus_w, std::vector<double> r) {
    const int size = int(r.size());
    std::vector<double> ratio(size);  // x_l = ratio_l x_{l+1} + r'_l
    double excess = one_minus_w;
    for (int l = 0; l < size; ++l) {
        if (l > 0) excess = (2 * l + 1) * one_minus_w + w * l * excess / (w * l + excess);
        const double pivot = w * (l + 1) + excess;
        ratio[l] = w * (l + 1) / pivot;
        r[l] = (r[l] + (l > 0 ? w * l * r[l - 1] : 0)) / pivot;
    }
    for (int l = size - 2; l >= 0; --l) r[l] += ratio[l] * r[l + 1];
    return r;
}

/// M_l = ∫_0^1 c P_l / (1 - w c)^2 dc, from c P_l (2l + 1) = (l + 1) P_{l+1} + l P_{l-1} applied to
// clang-format off
///   (1 - w c) [P_l / (1 - w c)] = P_l:
///       (2l + 1) J_l - w ((l + 1) J_{l+1} + l J_{l-1}) = (2l + 1) ∫_0^1 P_l dc,    J_l = ∫_0^1 P_l / (1 - w c) dc
///   (1 - w c) [c P_l / (1 - w c)^2] = c P_l / (1 - w c):
///       (2l + 1) M_l - w ((l + 1) M_{l+1} + l M_{l-1}) = (l + 1) J_{l+1} + l J_{l-1}
// clang-format on
/// Both are unstable as forward recurrences but stable as boundary value problems: an error at the far end decays as
/// e^{-b (size - l)}.
std::vector<double> ggx_moments(double alpha, int band_limit) {
    const double a2 = alpha * alpha, w = (1 - a2) / (1 + a2), one_minus_w = 2 * a2 / (1 + a2);
    const double decay = 2 * std::asinh(alpha / std::sqrt(std::max(1 - a2, 1e-12)));  // cosh(decay) = 1 / w
    const int size = band_limit + 10 + int(std::ceil(40 / decay));

    const std::vector<double> p0 = legendre_at_zero(size + 1);
    std::vector<double> r(size);
    r[0] = 1;
    for (int l = 1; l < size; ++l) r[l] = p0[l - 1] - p0[l + 1];  // (2l + 1) ∫_0^1 P_l
    const std::vector<double> j = solve_legendre_system(w, one_minus_w, r);
    for (int l = 0; l < size; ++l) r[l] = (l + 1 < size ? (l + 1) * j[l + 1] : 0) + (l > 0 ? l * j[l - 1] : 0);
    return solve_legendre_system(w, one_minus_w, std::move(r));
}

/// ∫_0^1 c (1 - c)^p P_l dc. From (1 - c)(P'_l + P'_{l-1}) = l (P_{l-1} - P_l), by parts, I_l = ∫_0^1 (1 - c)^p P_l
/// obeys
///   (l + p + 1) I_l = (l - p - 1) I_{l-1} + P_l(0) + P_{l-1}(0),
/// whose factor is below 1 in magnitude for every l.
std::vector<double> charlie_moments(double p, int band_limit) {
    const std::vector<double> p0 = legendre_at_zero(band_limit + 2);
    std::vector<double> plain(band_limit + 2), m(band_limit + 1);
    plain[0] = 1 / (p + 1);
    for (int l = 1; l < band_limit + 2; ++l) plain[l] = ((l - p - 1) * plain[l - 1] + p0[l] + p0[l - 1]) / (l + p + 1);
    for (int l = 0; l <= band_limit; ++l)
        m[l] = ((l + 1) * plain[l + 1] + (l > 0 ? l * plain[l - 1] : 0)) / (2 * l + 1);
    return m;
}

/// ∫_0^1 c^p P_l dc: I_0 = 1 / (p + 1), I_1 = 1 / (p + 2), I_{l+2} = I_l (p - l) / (p + l + 3).
std::vector<double> phong_moments(double p, int band_limit) {
    std::vector<double> m(band_limit + 1);
    for (int l = 0; l <= band_limit; ++l) m[l] = l < 2 ? 1 / (p + 1 + l) : m[l - 2] * (p - l + 2) / (p + l + 1);
    return m;
}

}  // namespace

KernelDensity::KernelDensity(const ZonalKernel& kernel) : lobe_(kernel.lobe), power_(lobe_power(kernel)) {
    assert(is_phong(kernel.lobe) ? kernel.width >= 0 : kernel.width <= 1);
    if (lobe_ == Lobe::ggx) {
        const double alpha = std::max(kernel.width, k_least_alpha), a2 = alpha * alpha;
        w_ = (1 - a2) / (1 + a2);
        one_minus_w_ = 2 * a2 / (1 + a2);
        scale_ = 1 / (2 * k_pi * ggx_integral(w_, one_minus_w_));
    } else if (lobe_ == Lobe::charlie) {
        scale_ = (power_ + 1) * (power_ + 2) / (2 * k_pi);
    } else {
        scale_ = (power_ + 1) / (2 * k_pi);
    }
}

double ZonalKernel::density(double theta) const {
    const double s = std::sin(theta / 2);
    return KernelDensity(*this)(2 * s * s, std::cos(theta));
}

std::vector<double> ZonalKernel::coefficients(int band_limit) const {
    assert(band_limit >= 0);
    std::vector<double> m;
    switch (lobe) {
        case Lobe::ggx:
            m = ggx_moments(std::max(width, k_least_alpha), band_limit);
            break;
        case Lobe::charlie:
            m = charlie_moments(lobe_power(*this), band_limit);
            break;
        default:
            m = phong_moments(lobe_power(*this), band_limit);
            break;
    }
    m.resize(band_limit + 1);
    const double norm = 1 / m[0];
    for (double& k : m) k *= norm;
    m[0] = 1;
    return m;
}

double ZonalKernel::angular_width() const {
    if (lobe == Lobe::ggx) {
        const double alpha = std::max(width, k_least_alpha);
        return alpha < 1 ? std::min(2 * alpha / std::sqrt(1 - alpha * alpha), k_pi) : k_pi;
    }
    const double p = lobe_power(*this);
    // charlie has its maximum at this height above the horizon and falls to 0 at the horizon.
    if (lobe == Lobe::charlie) return 1 / (p + 1);
    // c^p ~ e^(-p theta^2 / 2) has the spectrum e^(-l^2 / 2p): e^-16 at l = 16 / b, where that of ggx has fallen as
    // far.
    return p > 0 ? std::min(std::sqrt(8 / p), k_pi) : k_pi;
}

}  // namespace domelight
