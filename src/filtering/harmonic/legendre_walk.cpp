#include "filtering/harmonic/legendre_walk.h"

#include <numbers>

namespace domelight {
namespace {

using simd::k_ring_group;

/// A group takes part once one of its values exceeds this. Waiting groups are checked every few degrees, within which a
/// value can grow by 1e10.
constexpr double k_log_negligible = -55;  // 1e-24
constexpr int k_waiting_steps = 4;
/// Scaled values are rescaled when they exceed this.
constexpr double k_largest = 1e100;

/// The scaled value at which a waiting group must be checked: either it matters now, or it is about to leave the range
/// of doubles.
double wake_value(double log_scale) {
    return std::min(std::exp(std::min(k_log_negligible - log_scale, 700.0)), k_largest);
}

}  // namespace

LegendreWalk::LegendreWalk(const NorthernRings& rings, int band_limit)
    : rings_(rings),
      band_limit_(band_limit),
      log_norm_(band_limit + 1),
      steps_(band_limit / 2 + 4),
      p_(rings.padded),
      p_prev_(rings.padded),
      rows_(std::size_t(k_chunk) * rings.padded),
      log_scale_(rings.padded / k_ring_group),
      wake_(rings.padded / k_ring_group),
      active_(rings.padded / k_ring_group) {
    // P_mm = sqrt((2m + 1) / 4 pi  prod_{k=1}^{m} (2k - 1) / 2k) sin^m theta.
    double log_product = 0;
    for (int m = 0; m <= band_limit; ++m) {
        if (m > 0) log_product += std::log((2.0 * m - 1) / (2.0 * m));
        log_norm_[m] = 0.5 * (std::log((2.0 * m + 1) / (4 * std::numbers::pi)) + log_product);
    }
}

void LegendreWalk::start(int m, int parity) {
    const int count = padded_count(band_limit_, m, parity);
    const double m2 = double(m) * m;
    const auto e2 = [m2](double l) { return l * l > m2 ? (l * l - m2) / (4 * l * l - 1) : 0.0; };
    for (int i = 0; i < count; ++i) {
        const double l = m + parity + 2.0 * i;
        const double e_below2 = l >= 1 ? e2(l - 1) : 0, e_l2 = e2(l), e_above2 = e2(l + 1), e_above22 = e2(l + 2);
        const double b = 1 / std::sqrt(e_above2 * e_above22);
        steps_[i] = {(e_above2 + e_l2) * b, b, std::sqrt(e_l2 * e_below2) * b};
    }

    // sin theta below which even P_Lm stays under 1e-13 (measured; the caustic lies at m = L sin theta).
    const double least_sine = (m - 6 - 2.5 * std::cbrt(double(band_limit_))) / std::max(1, band_limit_);
    const int groups = rings_.padded / k_ring_group;
    first_possible_ = groups;
    for (int g = groups - 1; g >= 0; --g) {
        const int r0 = g * k_ring_group, last = std::min(r0 + k_ring_group, rings_.count) - 1;
        if (rings_.sin_theta[last] < least_sine) break;
        first_possible_ = g;
        const double scale = log_norm_[m] + m * rings_.log_sin_theta[last];
        active_[g] = scale > k_log_negligible;
        log_scale_[g] = active_[g] ? 0 : scale;
        wake_[g] = wake_value(scale);
        simd::scaled_powers(rings_.log_sin_theta.data() + r0, m, log_norm_[m] - log_scale_[g], k_ring_group,
                            p_.data() + r0);
        const double up = std::sqrt(2.0 * m + 3);
        for (int r = r0; r < r0 + k_ring_group; ++r) {
            if (r >= rings_.count) p_[r] = 0;
            if (parity) p_[r] *= rings_.cos_theta[r] * up;
            p_prev_[r] = 0;
        }
    }
}

/// Fills rows_ with the next `count` degrees and returns the first ring that takes part.
int LegendreWalk::advance(int first, int count) {
    const int groups = rings_.padded / k_ring_group;
    int first_active = groups;
    for (int g = first_possible_; g < groups; ++g) {
        if (!active_[g])
            advance_waiting_group(g, first, count);
        else {
            int end = g + 1;
            while (end < groups && active_[end]) ++end;
            const int r = g * k_ring_group;
            simd::legendre_rows(steps_.data() + first, count, rings_.cos2_theta.data() + r, p_.data() + r,
                                p_prev_.data() + r, (end - g) * k_ring_group, rows_.data() + r, rings_.padded);
            first_active = std::min(first_active, g);
            g = end - 1;
            continue;
        }
        if (active_[g]) first_active = std::min(first_active, g);
    }
    return first_active * k_ring_group;
}

/// The same for a group whose values are still negligible: only the state of the recurrence is advanced, at the group's
/// own scale, until one of them is not.
void LegendreWalk::advance_waiting_group(int group, int first, int count) {
    const int r0 = group * k_ring_group;
    float* rows = rows_.data() + r0;
    for (int i = 0; i < count; i += k_waiting_steps) {
        const int n = std::min(k_waiting_steps, count - i);
        simd::legendre_rows(steps_.data() + first + i, n, rings_.cos2_theta.data() + r0, p_.data() + r0,
                            p_prev_.data() + r0, k_ring_group, rows + std::ptrdiff_t(i) * rings_.padded, rings_.padded);
        if (active_[group]) continue;
        for (int k = 0; k < n; ++k) std::fill_n(rows + std::ptrdiff_t(i + k) * rings_.padded, k_ring_group, 0.f);
        double largest = 0;
        for (int r = r0; r < r0 + k_ring_group; ++r)
            largest = std::max({largest, std::abs(p_[r]), std::abs(p_prev_[r])});
        if (largest < wake_[group]) continue;
        double& scale = log_scale_[group];
        const bool matters = scale + std::log(largest) > k_log_negligible;
        const double shift = matters ? std::exp(scale) : 1 / k_largest;
        scale = matters ? 0 : scale + std::log(k_largest);
        wake_[group] = wake_value(scale);
        active_[group] = matters;
        for (int r = r0; r < r0 + k_ring_group; ++r) {
            p_[r] *= shift;
            p_prev_[r] *= shift;
        }
    }
}

}  // namespace domelight
