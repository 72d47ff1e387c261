#pragma once

#include "domelight/base/names.h"
#include "domelight/base/vec.h"
#include "domelight/image/image.h"

#include <span>
#include <vector>

namespace domelight {

/// Real orthonormal spherical harmonics Y_lm of a unit direction in world space for l < bands, at index l^2 + l + m,
/// polar axis +Z, no Condon-Shortley sign: Y_1 = sqrt(3 / 4 pi) (y, z, x), as in Ramamoorthi and Hanrahan 2001 (eq. 3).
void sh_basis(const Vec3d& direction, int bands, std::span<double> out);

/// Against the ringing of few bands: see sh_window().
enum class ShWindow { none, hann, lanczos };
template <>
struct EnumNames<ShWindow> {
    static constexpr const char* kind = "a window";
    static constexpr NamedValue<ShWindow> table[] = {
        {ShWindow::none, "none"},
        {ShWindow::hann, "hann"},
        {ShWindow::lanczos, "lanczos"},
    };
};

/// Multiplies band l by the window's weight (hann: (1 + cos(pi l / bands)) / 2; lanczos: sinc(l / bands)): less
/// ringing, more blur.
void sh_window(std::span<Vec3d> coefficients, ShWindow window);

/// The coefficients of E / pi from those of the radiance: band l is multiplied by A_l / pi (1, 2/3, 1/4, 0, -1/24, ...;
/// Ramamoorthi and Hanrahan 2001, eq. 8).
std::vector<Vec3d> sh_irradiance_over_pi(std::span<const Vec3d> radiance);

/// Value of the expansion in a direction.
Vec3d sh_evaluate(std::span<const Vec3d> coefficients, const Vec3d& direction);

/// Filament's nine numbers (sh.txt, key "sh"): E / pi with the basis constants folded in, order 1, y, z, x, xy, yz,
/// 3z^2-1, zx, x^2-y^2.
std::vector<Vec3d> sh_filament(std::span<const Vec3d> radiance);

/// A function of a unit direction d, one for each colour: x d.x + y d.y + z d.z + xx d.x^2 + ... + xy d.x d.y. A
/// constant c is xx = yy = zz = c.
struct QuadraticPolynomial {
    Vec3d x, y, z, xx, yy, zz, yz, zx, xy;
    Vec3d operator()(const Vec3d& d) const;
};

/// The expansion's first nine coefficients as a polynomial: the same function.
QuadraticPolynomial sh_polynomial(std::span<const Vec3d> coefficients);

}  // namespace domelight
