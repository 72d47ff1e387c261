#include "filtering/harmonic/spectrum_evaluate.h"

#include "domelight/filtering/harmonic/spherical_harmonics.h"

#include "base/gauss_legendre.h"

#include <cmath>
#include <complex>

namespace domelight {

Vec3d evaluate_spectrum(const Spectrum& spectrum, const Vec3d& direction, int band_limit,
                        const std::vector<double>& factors) {
    const double sine = std::hypot(direction.x, direction.z), norm = std::hypot(sine, direction.y),
                 x = direction.y / norm, s = sine / norm;
    const double phi = std::atan2(direction.z, direction.x);
    double sum[3] = {};
    double p_mm = std::sqrt(1 / (4 * k_pi));
    for (int m = 0; m <= band_limit; ++m) {
        if (m > 0) p_mm *= std::sqrt((2.0 * m + 1) / (2.0 * m)) * s;
        const std::complex<double> turn = std::polar(m ? 2.0 : 1.0, m * phi);
        // P_{l+1} = (x P_l - e_l P_{l-1}) / e_{l+1}.
        double p = p_mm, p_prev = 0, e = 0;
        for (int l = m; l <= band_limit; ++l) {
            const double k = factors.empty() ? 1 : factors[l];
            for (int c = 0; c < 3; ++c) sum[c] += k * p * (spectrum.coefficient(l, m, c) * turn).real();
            const double above = l + 1.0,
                         e_above = std::sqrt((above * above - double(m) * m) / (4 * above * above - 1));
            const double next = (x * p - e * p_prev) / e_above;
            p_prev = p;
            p = next;
            e = e_above;
        }
    }
    return {sum[0], sum[1], sum[2]};
}

std::vector<Vec3d> spectrum_to_sh(const Spectrum& spectrum, int bands, const Mat3& world_to_source) {
    // A rotation mixes the orders within a degree but not the degrees. So the truncated function is integrated against
    // the world's basis, by a rule that is exact for products of two such functions (Gauss-Legendre in z, equal steps
    // in azimuth).
    std::vector<Vec3d> out(bands * bands);
    std::vector<double> basis(bands * bands);
    const auto& rule = gauss_legendre(bands);
    const int azimuths = 2 * bands;
    for (int i = 0; i < bands; ++i)
        for (int j = 0; j < azimuths; ++j) {
            const double z = rule.x[i], r = std::sqrt(1 - z * z), phi = 2 * k_pi * (j + 0.5) / azimuths;
            const Vec3d d{r * std::cos(phi), r * std::sin(phi), z};
            const Vec3d value =
                evaluate_spectrum(spectrum, world_to_source * d, bands - 1) * (rule.w[i] * 2 * k_pi / azimuths);
            sh_basis(d, bands, basis);
            for (int k = 0; k < bands * bands; ++k) out[k] += value * basis[k];
        }
    return out;
}

}  // namespace domelight
