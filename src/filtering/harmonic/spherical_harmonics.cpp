#include "domelight/filtering/harmonic/spherical_harmonics.h"

#include "domelight/filtering/kernel/zonal_kernel.h"

#include <cassert>

namespace domelight {
namespace {

/// l of the coefficient at index i = l^2 + l + m.
int band_of(std::size_t i) {
    int l = int(std::sqrt(double(i)));
    while (std::size_t(l + 1) * (l + 1) <= i) ++l;
    return l;
}

int bands_of(std::size_t count) {
    assert(count > 0);
    return band_of(count - 1) + 1;
}

/// sin(pi x) / (pi x)
double sinc(double x) {
    return x == 0 ? 1 : std::sin(k_pi * x) / (k_pi * x);
}

}  // namespace

void sh_basis(const Vec3d& d, int bands, std::span<double> out) {
    assert(out.size() >= std::size_t(bands) * bands);
    // sin^m theta cos(m phi) and sin^m theta sin(m phi) are the parts of (x + i y)^m; `sectoral` is P_mm without its
    // sin^m theta.
    double cosine = 1, sine = 0, sectoral = std::sqrt(1 / (4 * k_pi));
    for (int m = 0; m < bands; ++m) {
        if (m > 0) {
            const double c = cosine * d.x - sine * d.y;
            sine = cosine * d.y + sine * d.x;
            cosine = c;
            sectoral *= std::sqrt((2 * m + 1.0) / (2 * m));
        }
        const double two = m > 0 ? std::sqrt(2.0) : 1;
        double before = 0, p = sectoral;
        for (int l = m; l < bands; ++l) {
            if (l > m) {
                // Normalised associated Legendre functions by degree, stable upwards (Press et al. 2007, eq. 6.7.9).
                const double l2 = double(l) * l, m2 = double(m) * m, k2 = (l - 1.0) * (l - 1.0);
                const double next =
                    std::sqrt((4 * l2 - 1) / (l2 - m2)) * (d.z * p - std::sqrt((k2 - m2) / (4 * k2 - 1)) * before);
                before = p;
                p = next;
            }
            out[l * l + l + m] = two * p * cosine;
            if (m > 0) out[l * l + l - m] = two * p * sine;
        }
    }
}

void sh_window(std::span<Vec3d> coefficients, ShWindow window) {
    if (window == ShWindow::none || coefficients.empty()) return;
    const double bands = bands_of(coefficients.size());
    for (std::size_t i = 0; i < coefficients.size(); ++i) {
        const double x = band_of(i) / bands;
        coefficients[i] *= (window == ShWindow::hann ? (1 + std::cos(k_pi * x)) / 2 : sinc(x));
    }
}

std::vector<Vec3d> sh_irradiance_over_pi(std::span<const Vec3d> radiance) {
    std::vector<Vec3d> out(radiance.begin(), radiance.end());
    if (out.empty()) return out;
    const std::vector<double> k = ZonalKernel::cosine().coefficients(bands_of(out.size()) - 1);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] *= k[band_of(i)];
    return out;
}

Vec3d sh_evaluate(std::span<const Vec3d> coefficients, const Vec3d& direction) {
    if (coefficients.empty()) return {};
    const int bands = bands_of(coefficients.size());
    std::vector<double> basis(std::size_t(bands) * bands);
    sh_basis(direction, bands, basis);
    Vec3d sum;
    for (std::size_t i = 0; i < coefficients.size(); ++i) sum += coefficients[i] * basis[i];
    return sum;
}

std::vector<Vec3d> sh_filament(std::span<const Vec3d> radiance) {
    // The constants of Y_lm in front of the polynomials (Ramamoorthi and Hanrahan 2001, eq. 3).
    const double c1 = std::sqrt(3 / (4 * k_pi)), c2 = std::sqrt(15 / (4 * k_pi));
    const double constants[9] = {std::sqrt(1 / (4 * k_pi)), c1, c1, c1, c2, c2, std::sqrt(5 / (16 * k_pi)), c2, c2 / 2};
    std::vector<Vec3d> out = sh_irradiance_over_pi(radiance.first(std::min<std::size_t>(9, radiance.size())));
    out.resize(9);
    for (int i = 0; i < 9; ++i) out[i] *= constants[i];
    return out;
}

Vec3d QuadraticPolynomial::operator()(const Vec3d& d) const {
    return x * d.x + y * d.y + z * d.z + xx * (d.x * d.x) + yy * (d.y * d.y) + zz * (d.z * d.z) + yz * (d.y * d.z) +
           zx * (d.z * d.x) + xy * (d.x * d.y);
}

QuadraticPolynomial sh_polynomial(std::span<const Vec3d> coefficients) {
    std::vector<Vec3d> a(coefficients.begin(),
                         coefficients.begin() + std::min<std::ptrdiff_t>(9, std::ssize(coefficients)));
    a.resize(9);
    // Ramamoorthi and Hanrahan 2001, eq. 3, with 1 = x^2 + y^2 + z^2 and 3 z^2 - 1 = 2 z^2 - x^2 - y^2.
    const double c0 = std::sqrt(1 / (4 * k_pi)), c1 = std::sqrt(3 / (4 * k_pi)), c2 = std::sqrt(15 / (4 * k_pi)),
                 c20 = std::sqrt(5 / (16 * k_pi));
    QuadraticPolynomial p;
    p.x = a[3] * c1, p.y = a[1] * c1, p.z = a[2] * c1;
    p.xx = a[0] * c0 - a[6] * c20 + a[8] * (c2 / 2);
    p.yy = a[0] * c0 - a[6] * c20 - a[8] * (c2 / 2);
    p.zz = a[0] * c0 + a[6] * (2 * c20);
    p.yz = a[5] * c2, p.zx = a[7] * c2, p.xy = a[4] * c2;
    return p;
}

}  // namespace domelight
