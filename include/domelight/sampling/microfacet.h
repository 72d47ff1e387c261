#pragma once

#include "domelight/base/unit_point.h"
#include "domelight/base/vec.h"
#include "domelight/sampling/warps.h"

#include <algorithm>

/// The parts of microfacet BRDFs: distributions of normals, masking, Fresnel, and sampling of normals. Directions are
/// local: the surface's normal is +Z, and all directions point away from the surface, V towards the viewer and L
/// towards the light. H = V + L has any positive length unless stated otherwise.
namespace domelight {

/// GGX distribution of microfacet normals.
///
/// H       microfacet normal, of any length (it cancels), H.z > 0
/// alpha   GGX width, (0, 1]
/// returns density per steradian, >= 0; D NdotH integrates to 1 over the hemisphere
///
/// Walter et al. 2007, eq. 33, rewritten as alpha^2 / (pi (sin^2 + alpha^2 cos^2)^2). The sine is computed from H.x and
/// H.y, because 1 - cos^2 has no digits left for a narrow lobe.
template <typename T>
T ggx_d(const Vec3<T>& H, T alpha) {
    const T a2 = alpha * alpha, sin2 = H.x * H.x + H.y * H.y, cos2 = H.z * H.z;
    const T ratio = (sin2 + cos2) / (sin2 + a2 * cos2);
    return a2 * ratio * ratio / T(k_pi);
}

/// sqrt(alpha^2 + (1 - alpha^2) c^2) of a cosine c, a part of Smith's terms for GGX.
template <typename T>
T ggx_smith_root(T cosine, T alpha) {
    const T a2 = alpha * alpha;
    return std::sqrt(a2 + (1 - a2) * cosine * cosine);
}

/// Smith's masking for GGX, in [0, 1], 0 at NdotV = 0: the visible share of the microfacets that face V (NdotV in [0,
/// 1], alpha > 0). Walter et al. 2007, eq. 34.
template <typename T>
T ggx_g1(T NdotV, T alpha) {
    return 2 * NdotV / (NdotV + ggx_smith_root(NdotV, alpha));
}

/// Visibility G2 / (4 NdotL NdotV) of GGX with height-correlated masking and shadowing: Heitz 2014, eq. 99.
/// Cosines >= 0 and not both 0.
template <typename T>
T ggx_visibility(T NdotL, T NdotV, T alpha) {
    return T(0.5) / (NdotV * ggx_smith_root(NdotL, alpha) + NdotL * ggx_smith_root(NdotV, alpha));
}

/// The same with masking and shadowing independent of each other, G1(l) G1(v): Walter et al. 2007, eq. 23. Never
/// larger.
template <typename T>
T ggx_visibility_separable(T NdotL, T NdotV, T alpha) {
    return 1 / ((NdotL + ggx_smith_root(NdotL, alpha)) * (NdotV + ggx_smith_root(NdotV, alpha)));
}

/// Distribution of normals of the sheen lobe, (2 + 1/alpha) sin^(1/alpha) / (2 pi): Estevez and Kulla 2017, eq. 2.
///
/// sin2_H  squared sine of the microfacet normal's polar angle, [0, 1]
/// alpha   roughness^2, (0, 1]
/// returns density per steradian; D NdotH integrates to 1 over the hemisphere
template <typename T>
T charlie_d(T sin2_H, T alpha) {
    return (2 + 1 / alpha) * std::pow(sin2_H, T(0.5) / alpha) / T(2 * k_pi);
}

/// Visibility of the sheen lobe, 1 / (4 (NdotL + NdotV - NdotL NdotV)): Neubelt and Pettineo 2013, as in glTF.
template <typename T>
T sheen_visibility(T NdotL, T NdotV) {
    return T(0.25) / (NdotL + NdotV - NdotL * NdotV);
}

/// Schlick's Fc = (1 - VdotH)^5, the weight of f90; VdotH in [0, 1] (larger values, from rounding, count as 1).
template <typename T>
T schlick_weight(T VdotH) {
    const T x = 1 - std::min(VdotH, T(1));
    return x * x * x * x * x;
}

/// Fresnel reflectance f0 + (f90 - f0) (1 - VdotH)^5: Schlick 1994, eq. 15.
inline Vec3f fresnel_schlick(float VdotH, const Vec3f& f0, const Vec3f& f90 = {1, 1, 1}) {
    return f0 + (f90 - f0) * schlick_weight(VdotH);
}

/// The mirror image of V about H, which may have any length but 0: 2 (V.H) H / (H.H) - V.
inline Vec3f reflect_about(const Vec3f& V, const Vec3f& H) {
    return H * (2 * dot(V, H) / dot(H, H)) - V;
}

/// Squares of the cosine and the sine of a polar angle.
struct PolarSquares {
    double cos2, sin2;
};

/// The polar angle of a normal of density D NdotH (GGX), from u in [0, 1): tan^2 = alpha^2 u / (1 - u), Walter et al.
/// 2007, eq. 35, in the form of Karis 2013, with the sine computed without cancellation.
inline PolarSquares ggx_half_angle(double u, double alpha2) {
    const double scale = 1 + (alpha2 - 1) * u;
    return {(1 - u) / scale, alpha2 * u / scale};
}

/// A normal of unit length with density D NdotH (GGX): u.x chooses the polar angle, u.y the azimuth.
inline Vec3f ggx_half_vector(float alpha, UnitPoint u) {
    // In double: near u = 1 the tail of the lobe depends on all 32 bits.
    const PolarSquares h = ggx_half_angle(unit_double(u.x), double(alpha) * alpha);
    const float s = std::sqrt(float(h.sin2));
    const CirclePoint azimuth = circle_point(u.y);
    return {s * azimuth.x, s * azimuth.y, std::sqrt(float(h.cos2))};
}

/// A normal of unit length with density D NdotH (Charlie): sin theta = u^(alpha / (2 alpha + 1)), Estevez and Kulla
/// 2017, as in the Khronos tools.
inline Vec3f charlie_half_vector(float alpha, UnitPoint u) {
    // 1 - sin is computed by expm1, because at small alpha all normals lie near the horizon
    const float q = -std::expm1(std::log(unit_float(u.x)) * (alpha / (2 * alpha + 1))), s = 1 - q;
    const CirclePoint azimuth = circle_point(u.y);
    return {s * azimuth.x, s * azimuth.y, std::sqrt(q * (2 - q))};
}

/// V in the space where GGX is a hemisphere, unit length.
inline Vec3f ggx_stretch(const Vec3f& V, float alpha) {
    return normalize(Vec3f{alpha * V.x, alpha * V.y, V.z});
}

/// A normal of unit length that is visible from V, with density D_V = G1 max(V.H, 0) D / V.z (unit V, V.z >= 0): Heitz
/// 2018, "Sampling the GGX distribution of visible normals", the plain reference for the two forms below.
inline Vec3f ggx_visible_normal_heitz(const Vec3f& V, float alpha, UnitPoint u) {
    const Vec3f axis = ggx_stretch(V, alpha);
    // Section 4.1: a basis about the axis
    const float across = axis.x * axis.x + axis.y * axis.y;
    const Vec3f t1 = across > 0 ? Vec3f{-axis.y, axis.x, 0} / std::sqrt(across) : Vec3f{1, 0, 0}, t2 = cross(axis, t1);
    // Section 4.2: the hemisphere's projection onto the plane across V is a half disk above an ellipse of half-width z
    const float r = std::sqrt(unit_float(u.x));
    const CirclePoint azimuth = circle_point(u.y);
    const float p1 = r * azimuth.x, edge = std::sqrt(std::max(0.f, 1 - p1 * p1)), s = 0.5f * (1 + axis.z);
    const float p2 = (1 - s) * edge + s * r * azimuth.y;
    // Sections 4.3 and 3.4: from the plane up to the hemisphere, and from the hemisphere back to the ellipsoid
    const Vec3f n = t1 * p1 + t2 * p2 + axis * std::sqrt(std::max(0.f, 1 - p1 * p1 - p2 * p2));
    return normalize(Vec3f{alpha * n.x, alpha * n.y, std::max(1e-20f, n.z)});
}

/// The factor k by which Eto and Tokuyoshi make the cap lower: the cap to sample is {z > -k axis.z}, and k = 1 would be
/// the full cap. In the stretched space, reflections of V by GGX's visible normals fill {z > -axis.z}; those that leave
/// the surface fill only {z > -k axis.z} (Eto and Tokuyoshi 2023, eq. 5, one alpha in (0, 1]).
inline float ggx_cap_bound(const Vec3f& V, float alpha) {
    const float s = 1 + std::sqrt(V.x * V.x + V.y * V.y), a2 = alpha * alpha, s2 = s * s;
    return (1 - a2) * s2 / (s2 + a2 * V.z * V.z);
}

/// A normal visible from V (unit, V.z >= 0), not of unit length, from a uniform point of a spherical cap: Dupuy and
/// Benyoub 2023, "Sampling visible GGX normals with spherical caps". With `bound` = 1 the density is that of
/// ggx_visible_normal_heitz(). With `bound` = ggx_cap_bound() the cap's height is 1 + bound axis.z instead of 1 +
/// axis.z, and most normals that reflect into the surface are left out ("Bounded VNDF sampling for Smith-GGX
/// reflections", Eto and Tokuyoshi 2023).
inline Vec3f ggx_visible_normal_cap(const Vec3f& V, float alpha, UnitPoint u, float bound = 1) {
    const Vec3f axis = ggx_stretch(V, alpha);
    // z is uniform in (-bound axis.z, 1]. Computed as q = 1 - z, so that the sine keeps its digits near the pole
    const float q = unit_float(u.x) * (1 + bound * axis.z), s = std::sqrt(q * (2 - q));
    const CirclePoint azimuth = circle_point(u.y);
    // A uniform direction of the cap plus the axis is the half vector of a reflection off a hemisphere, which is then
    // unstretched. Its z is positive, because u < 1, and (1 - 2^-24) (1 + axis.z) rounds to less than 1 + axis.z.
    return {alpha * (axis.x + s * azimuth.x), alpha * (axis.y + s * azimuth.y), axis.z + (1 - q)};
}

}  // namespace domelight
