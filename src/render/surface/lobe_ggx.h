#pragma once
// GGX with different widths along two axes, for brushed metal. Like the isotropic lobe of brdf.h, with the axes x and y
// of the local frame.

#include "domelight/sampling/brdf.h"

namespace domelight {

/// D and the masking of an ellipsoidal GGX, and sampling from it. V, L and H as in microfacet.h; x is the direction in
/// which the surface is `alpha_x` rough.
struct EllipticGgx {
    float alpha_x = 1, alpha_y = 1;  ///< [k_least_brdf_alpha, 1]

    /// Density of microfacet normals, per steradian; H of any length. Heitz 2014, eq. 85, with tan^2 cos^4 written out:
    /// |H|^4 / (pi ax ay (x^2 / ax^2 + y^2 / ay^2 + z^2)^2).
    float distribution(const Vec3f& H) const {
        const Vec3f scaled{H.x / alpha_x, H.y / alpha_y, H.z};
        const float ratio = dot(H, H) / dot(scaled, scaled);
        return ratio * ratio / (float(k_pi) * alpha_x * alpha_y);
    }
    /// |(ax x, ay y, z)| of a unit direction, a part of Smith's terms (Heitz 2014, eq. 87, G1 = 2 z / (z + root)).
    float root(const Vec3f& v) const {
        const float x = alpha_x * v.x, y = alpha_y * v.y;
        return std::sqrt(x * x + y * y + v.z * v.z);
    }
    float masking(const Vec3f& v) const { return 2 * std::abs(v.z) / (std::abs(v.z) + root(v)); }
    /// G2 / (4 NdotL NdotV), height-correlated.
    float visibility(const Vec3f& V, const Vec3f& L) const { return 0.5f / (V.z * root(L) + L.z * root(V)); }

    /// f without the Fresnel term.
    float evaluate(const Vec3f& V, const Vec3f& L) const {
        return detail::above(V, L) ? distribution(V + L) * visibility(V, L) : 0;
    }
    /// The lowest z of the cap: Eto and Tokuyoshi 2023, eq. 5 and 6, which for two widths takes the smaller one.
    float cap_bound(const Vec3f& V) const { return ggx_cap_bound(V, std::min(alpha_x, alpha_y)); }
    /// A normal visible from V, of any length; `bound` as for ggx_visible_normal_cap().
    Vec3f draw(const Vec3f& V, UnitPoint u, float bound) const {
        const Vec3f axis = normalize(Vec3f{alpha_x * V.x, alpha_y * V.y, V.z});
        const float q = unit_float(u.x) * (1 + bound * axis.z), s = std::sqrt(q * (2 - q));
        const CirclePoint azimuth = circle_point(u.y);
        return {alpha_x * (axis.x + s * azimuth.x), alpha_y * (axis.y + s * azimuth.y), axis.z + (1 - q)};
    }
    /// Density of the mirror image of V about the normal that draw() returns: D / (2 (bound V.z + root)).
    float pdf_reflected(const Vec3f& V, const Vec3f& L, float bound) const {
        return distribution(V + L) / (2 * (bound * V.z + root(V)));
    }

    float pdf_solid_angle(const Vec3f& V, const Vec3f& L) const {
        return detail::above(V, L) ? pdf_reflected(V, L, cap_bound(V)) : 0;
    }
    Vec3f sample(const Vec3f& V, UnitPoint u) const { return reflect_about(V, draw(V, u, cap_bound(V))); }
};

}  // namespace domelight
