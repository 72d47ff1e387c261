#include "preview/preview_sh.h"

#include "domelight/projection.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

constexpr int k_most_bands = 16;

/// A_l / pi of the clamped cosine: 1, 2/3, 1/4, 0, -1/24, 0, ... Ramamoorthi and Hanrahan 2001, eq. 8.
double cosine_factor(int l) {
    if (l == 1) return 2.0 / 3;
    if (l % 2) return 0;
    double binomial = 1;  // l! / (2^l (l/2)!^2)
    for (int k = 1; k <= l / 2; ++k) binomial *= (k + l / 2.0) / (4.0 * k);
    return 2 * (l / 2 % 2 ? 1 : -1) / ((l + 2.0) * (l - 1.0)) * binomial;
}

/// The value in one direction: for each order m, the normalised Legendre functions over l by their recurrence, times
/// cos or sin of m phi.
Vec3d evaluate(std::span<const Vec3d> coefficients, int bands, const Vec3d& d) {
    Vec3d sum;
    double cos_m = 1, sin_m = 0;  // sin^m(theta) times cos and sin of m phi: polynomials in x and y
    double diagonal = std::sqrt(1 / (4 * k_pi));
    for (int m = 0; m < bands; ++m) {
        double before = 0, now = diagonal;
        for (int l = m; l < bands; ++l) {
            const double scale = now * (m ? std::numbers::sqrt2 : 1);
            sum = sum + coefficients[l * l + l + m] * (scale * cos_m);
            if (m) sum = sum + coefficients[l * l + l - m] * (scale * sin_m);
            const double n = l + 1, a = std::sqrt((4 * n * n - 1) / (n * n - m * m));
            const double b = l == 0 ? 0 : std::sqrt((double(l) * l - m * m) / (4.0 * l * l - 1));
            const double next = a * (d.z * now - b * before);
            before = now;
            now = next;
        }
        diagonal *= std::sqrt((2 * m + 3.0) / (2 * m + 2.0));
        const double c = d.x * cos_m - d.y * sin_m;
        sin_m = d.x * sin_m + d.y * cos_m;
        cos_m = c;
    }
    return sum;
}

}  // namespace

std::vector<Vec3d> sh_irradiance_picture(std::span<const Vec3d> radiance, int rows) {
    int bands = 0;
    while (bands < k_most_bands && std::size_t(bands + 1) * (bands + 1) <= radiance.size()) ++bands;
    std::vector<Vec3d> scaled(radiance.begin(), radiance.begin() + bands * bands);
    for (int l = 0; l < bands; ++l)
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) scaled[i] = scaled[i] * cosine_factor(l);
    std::vector<Vec3d> picture;
    picture.reserve(std::size_t(2) * rows * rows);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < 2 * rows; ++x)
            picture.push_back(evaluate(scaled, bands, latlong_direction({(x + 0.5) / (2 * rows), (y + 0.5) / rows})));
    return picture;
}

}  // namespace domelight
