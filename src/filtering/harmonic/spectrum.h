#pragma once

#include "base/aligned.h"
#include "filtering/harmonic/legendre_walk.h"

#include <algorithm>
#include <complex>

namespace domelight {

/// Spherical-harmonic coefficients a_lm, m >= 0, of an RGB function on the sphere up to a band limit, in the source's
/// frame: polar axis +Y, azimuth from +X towards +Z, orthonormal Y_lm = P_lm(cos theta) e^{i m phi} without the
/// Condon-Shortley sign. The function is real: a_{l,-m} = conj(a_lm).
///
/// Stored by m, then parity of l - m, then degree: six floats (re, im of R, G, B) each, in pairs of degrees as the
/// kernels take them.
class Spectrum {
  public:
    Spectrum() = default;
    explicit Spectrum(int band_limit) : band_limit_(band_limit), offset_(2 * std::size_t(band_limit + 1) + 1) {
        std::size_t at = 0;
        for (int m = 0; m <= band_limit; ++m)
            for (int parity = 0; parity < 2; ++parity) {
                offset_[2 * m + parity] = at;
                at += 6 * std::size_t(LegendreWalk::padded_count(band_limit, m, parity));
            }
        offset_.back() = at;
        values_ = AlignedArray<float>(at);
    }

    int band_limit() const { return band_limit_; }
    /// The degrees l = m + parity + 2 i of one order: [i][6].
    float* block(int m, int parity) { return values_.data() + offset_[2 * m + parity]; }
    const float* block(int m, int parity) const { return values_.data() + offset_[2 * m + parity]; }
    /// Degrees in a block, padding (of value zero) included.
    int block_count(int m, int parity) const { return LegendreWalk::padded_count(band_limit_, m, parity); }

    std::complex<double> coefficient(int l, int m, int channel) const {
        const float* a = block(m, (l - m) % 2) + 6 * std::size_t((l - m) / 2) + 2 * channel;
        return {a[0], a[1]};
    }

    /// Adds another function's coefficients, of the degrees that both have.
    void add(const Spectrum& other) {
        const int shared = std::min(band_limit_, other.band_limit_);
        for (int m = 0; m <= shared; ++m)
            for (int parity = 0; parity < 2 && m + parity <= shared; ++parity) {
                const int count = 6 * ((shared - m - parity) / 2 + 1);
                float* mine = block(m, parity);
                const float* theirs = other.block(m, parity);
                for (int i = 0; i < count; ++i) mine[i] += theirs[i];
            }
    }

  private:
    int band_limit_ = -1;
    std::vector<std::size_t> offset_;
    AlignedArray<float> values_;
};

}  // namespace domelight
