#include "filtering/kernel/residual_kernel.h"

#include "domelight/base/vec.h"

#include "base/gauss_legendre.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// The Kaiser window's parameter: R falls to about e^-beta of its largest value within 3.2 beta / (L - L0) of a kink, L0
/// being the degree at which the taper begins. Charlie's kink is the steepest.
double window_beta(const ZonalKernel& kernel) {
    return kernel.lobe == Lobe::charlie ? 15 : 11;
}
constexpr double k_reach = 3.2;
/// Table entries for each wave of the last degree: linear interpolation is then off by (pi / 32)^2 / 8, a thousandth of R.
constexpr int k_per_wave = 64;

/// The degree up to which the coefficients of the smooth part of the kernel matter: it must not be tapered.
int smooth_degrees(const ZonalKernel& kernel) {
    switch (kernel.lobe) {
        case Lobe::ggx:
            return int(12.5 / kernel.angular_width());
        case Lobe::charlie:
            return int(4 / std::sqrt(std::max(kernel.width, 1e-3)));
        default:
            return 0;
    }
}

int taper_start(const ZonalKernel& kernel, int band_limit) {
    return std::clamp(smooth_degrees(kernel), 8, std::max(8, band_limit / 2));
}

/// (1 - c)^p is not smooth at the axis.
bool has_kink_at_axis(const ZonalKernel& kernel) {
    return kernel.lobe == Lobe::charlie;
}

/// The modified Bessel function I_0, of arguments up to 15: Σ (x²/4)^k / k!².
double bessel_i0(double x) {
    double sum = 1, term = 1;
    for (int k = 1; k <= 40; ++k) sum += term *= 0.25 * x * x / (double(k) * k);
    return sum;
}

/// Σ w_l (2l + 1)/4π P_l(c) at each cosine.
std::vector<double> legendre_series(std::span<const double> w, const std::vector<double>& cosines) {
    const std::size_t n = cosines.size();
    std::vector<double> p(n, 1.0), before(n, 0.0), sum(n, 0.0);
    for (std::size_t l = 0; l < w.size(); ++l) {
        const double degree = double(l), weight = (2 * degree + 1) / (4 * k_pi) * w[l],
                     a = (2 * degree + 1) / (degree + 1), b = degree / (degree + 1);
        for (std::size_t i = 0; i < n; ++i) {
            sum[i] += weight * p[i];
            const double next = a * cosines[i] * p[i] - b * before[i];
            before[i] = p[i];
            p[i] = next;
        }
    }
    return sum;
}

/// [i]: the largest of values i and after.
std::vector<double> largest_from(std::vector<double> values) {
    for (int i = int(values.size()) - 2; i >= 0; --i) values[i] = std::max(values[i], values[i + 1]);
    return values;
}

/// The first index whose value, of a falling sequence, is at most `error`; the last if there is none.
int first_within(const std::vector<double>& falling, double error) {
    const auto found = std::partition_point(falling.begin(), falling.end() - 1, [&](double v) { return v > error; });
    return int(found - falling.begin());
}

/// w_l, l = 0..L: 1 up to degree `from`, then 1 minus the integral of the Kaiser window over the degrees from there on, 0
/// at L + 1. The integral must be accurate: an error of 1e-6 in w_l would be visible far from the kinks.
std::vector<double> taper(int from, int band_limit, double beta) {
    const int degrees = band_limit + 1 - from;
    const auto& rule = gauss_legendre(6);
    std::vector<double> integral(degrees + 1, 0.0);
    for (int i = 0; i < degrees; ++i) {
        double sum = 0;
        for (std::size_t q = 0; q < rule.x.size(); ++q) {
            const double t = (2 * i + 1 + rule.x[q]) / degrees - 1;
            sum += rule.w[q] * bessel_i0(beta * std::sqrt(1 - t * t));
        }
        integral[i + 1] = integral[i] + sum;
    }
    std::vector<double> w(band_limit + 1, 1.0);
    for (int i = 0; i < degrees; ++i) w[from + i] = 1 - integral[i] / integral[degrees];
    return w;
}

}  // namespace

ResidualKernel::ResidualKernel(const ZonalKernel& kernel, std::span<const double> factors) : removed_(factors.size()) {
    const int band_limit = int(factors.size()) - 1, from = taper_start(kernel, band_limit);
    const std::vector<double> w = taper(from, band_limit, window_beta(kernel));
    std::vector<double> tapered(factors.size());
    for (int l = 0; l <= band_limit; ++l) {
        tapered[l] = w[l] * factors[l];
        removed_[l] = -(1 - w[l]) * factors[l];
    }
    reach_ = std::min(k_reach * window_beta(kernel) / (band_limit + 1 - from), 1.0);
    const int steps = int(std::ceil(reach_ * (band_limit + 1) * k_per_wave / (2 * k_pi)));

    // The cosines of the ring's entries, then those of the axis' entries.
    std::vector<double> cosines;
    for (int i = -steps; i <= steps; ++i) cosines.push_back(reach_ * i / steps);
    const int of_axis = has_kink_at_axis(kernel) ? steps : 1;
    for (int i = 0; i <= of_axis; ++i) cosines.push_back(1 - 0.5 * std::pow(reach_ * i / of_axis, 2));
    const std::vector<double> smooth = legendre_series(tapered, cosines);

    ring_.resize(2 * steps + 1);
    ring_rest_.assign(steps + 1, 0.0);
    axis_.resize(of_axis + 1);
    axis_rest_.resize(of_axis + 1);
    for (int i = 0; i < int(ring_.size()); ++i) {
        const double density = kernel.density(std::acos(cosines[i])), rest = density - smooth[i];
        ring_[i] = float(rest);
        double& largest = ring_rest_[std::abs(i - steps)];
        largest = std::max(largest, std::abs(rest) - k_allowed * density);
    }
    for (int i = 0; has_kink_at_axis(kernel) && i <= of_axis; ++i) {
        const double density = kernel.density(2 * std::asin(0.5 * reach_ * i / of_axis)),
                     rest = density - smooth[ring_.size() + i];
        axis_[i] = float(rest);
        axis_rest_[i] = std::abs(rest) - k_allowed * density;
    }
    ring_.front() = ring_.back() = axis_.back() = 0;
    ring_rest_ = largest_from(std::move(ring_rest_));
    axis_rest_ = largest_from(std::move(axis_rest_));
}

double ResidualKernel::ring_limit(double error) const {
    return reach_ * first_within(ring_rest_, error) / (int(ring_rest_.size()) - 1);
}

double ResidualKernel::axis_limit(double error) const {
    return reach_ * first_within(axis_rest_, error) / (int(axis_rest_.size()) - 1);
}

}  // namespace domelight
