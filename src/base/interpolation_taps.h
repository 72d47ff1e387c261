#pragma once

#include <span>
#include <vector>

namespace domelight {

/// How far the spectrum of a filtered environment has fallen at its band limit, at the least: the `decay` below.
inline constexpr double k_filtered_decay = 16;

/// Weights that interpolate a band-limited function between equally spaced samples, as polynomials of the position
/// between two of them.
///
/// f(i + t) ~ sum_k w_k(t) f(i + k - (taps / 2 - 1)), k = 0..taps-1, t in [0, 1]. The weights are the least-squares
/// optimum for a signal whose amplitude falls as x K_1(x), x = decay * omega / (pi band): the spectrum of a
/// GGX-filtered environment, so that the strong low frequencies are exact to 1e-6, at the expense of the highest ones,
/// which no longer matter. They sum to exactly 1: a constant stays constant.
class InterpolationTaps {
  public:
    /// taps    even, 2..16
    /// band    highest frequency over the sampling's Nyquist frequency, (0, 1)
    /// decay   how far the spectrum has fallen at the band's end: exp(-decay), >= 0
    InterpolationTaps(int taps, double band, double decay);

    int taps() const { return taps_; }
    int degree() const { return degree_; }
    /// Coefficient of t^d in the weight of sample k.
    double coefficient(int d, int k) const { return coefficients_[d * taps_ + k]; }
    /// The weights at `t` into `out` (taps() of them).
    void weights(double t, std::span<double> out) const;

  private:
    int taps_, degree_;
    std::vector<double> coefficients_;  ///< [degree + 1][taps]
};

}  // namespace domelight
