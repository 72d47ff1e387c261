#pragma once

#include "domelight/base/names.h"

#include <vector>

namespace domelight {

/// Which rotationally symmetric lobe an environment is convolved with.
enum class Lobe {
    ggx,          ///< GGX with n = v = r, weighted by n.l: K(c) ~ max(c, 0) / (alpha^2 (1 + c) + 1 - c)^2
    charlie,      ///< sheen, as the Khronos tools sample it: K(c) ~ max(c, 0) (1 - c)^(1 / (2 alpha))
    phong_brdf,   ///< modified Phong BRDF under n = v = r: (n + 2) / (2 pi) max(c, 0)^(n + 1)
    phong_plain,  ///< plain Phong map: (n + 1) / (2 pi) max(c, 0)^n
};
template <>
struct EnumNames<Lobe> {
    static constexpr const char* kind = "a lobe";
    static constexpr NamedValue<Lobe> table[] = {
        {Lobe::ggx, "ggx"},
        {Lobe::charlie, "charlie"},
        {Lobe::phong_brdf, "phong"},
        {Lobe::phong_plain, "phong-plain"},
    };
};

/// Whether a lobe's width is an exponent.
inline bool is_phong(Lobe lobe) {
    return lobe == Lobe::phong_brdf || lobe == Lobe::phong_plain;
}

/// A lobe with its width: a density per steradian that depends only on c, the cosine of the angle to the lobe's axis,
/// and integrates to 1 over the sphere. docs/math/prefilter.md derives each one.
struct ZonalKernel {
    Lobe lobe = Lobe::ggx;
    double width = 1;  ///< ggx and charlie: alpha = roughness^2, in (0, 1]; phong: the exponent n >= 0

    static ZonalKernel ggx(double roughness) { return {Lobe::ggx, roughness * roughness}; }
    static ZonalKernel charlie(double roughness) { return {Lobe::charlie, roughness * roughness}; }
    /// The clamped cosine max(c, 0) / pi: convolving with it gives E / pi. The same as ggx at alpha = 1.
    static ZonalKernel cosine() { return {Lobe::ggx, 1}; }

    /// Density per steradian at angle `theta` (radians, 0..pi) from the axis. The argument is the angle and not its
    /// cosine c, because 1 - c would lose its digits near the axis.
    double density(double theta) const;

    /// The eigenvalues k_l = 2 pi ∫ K(c) P_l(c) dc for l = 0..band_limit, k_0 = 1. In double, absolute error below
    /// 1e-9.
    std::vector<double> coefficients(int band_limit) const;

    /// The kernel's characteristic width as an angle in radians, at most pi. ggx: 2 alpha / sqrt(1 - alpha^2); charlie:
    /// 1 / (p + 1) with p = 1 / (2 alpha); phong: sqrt(8 / p) with p the power of the cosine.
    double angular_width() const;

    friend bool operator==(const ZonalKernel&, const ZonalKernel&) = default;
};

}  // namespace domelight
