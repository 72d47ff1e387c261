#pragma once

#include "domelight/base/frame.h"
#include "domelight/sampling/microfacet.h"

/// BRDFs that can be sampled. Each has the functions below. Directions are in a local frame whose normal is +Z; V
/// (towards the viewer) and L (towards the light) have unit length and point away from the surface:
///
///   Vec3f evaluate(V, L)            the BRDF's value f, per steradian, without the cosine
///   float pdf_solid_angle(V, L)     density with which sample() draws L, per steradian
///   BrdfSample sample(V, u)         L, its density, and f L.z / density
///
/// All are 0 unless V.z >= 0 and L.z > k_least_cosine. A direction drawn below the horizon has density 0 and weight 0,
/// and counts: an estimate divides by the number of all draws, so pdf_solid_angle() integrates to 1 minus the share of
/// such directions. No result is NaN or infinite for any u, any V.z >= 0 and any parameter in range. V below the
/// horizon gives zeros.
namespace domelight {

struct BrdfSample {
    Vec3f L;                    ///< unit length
    float pdf_solid_angle = 0;  ///< per steradian, the same bits as pdf_solid_angle(V, L); 0: L is below the horizon
    Vec3f weight;               ///< evaluate(V, L) L.z / pdf_solid_angle; 0 where the density is
};

/// Smaller alphas are raised to this value. Directions in float (6e-8) resolve a lobe of this width to about 1e-3, and
/// less well at grazing angles, where the half vector magnifies their rounding by 1 / V.z.
inline constexpr float k_least_brdf_alpha = 1e-4f;

/// Light whose cosine is not above this counts as below the horizon. The square of this value is still a normal float.
inline constexpr float k_least_cosine = 1e-9f;

namespace detail {

inline bool above(const Vec3f& V, const Vec3f& L) {
    return V.z >= 0 && L.z > k_least_cosine;
}
template <typename Brdf>
BrdfSample with_density(const Brdf& brdf, const Vec3f& V, const Vec3f& L) {
    const float pdf = brdf.pdf_solid_angle(V, L);
    if (!(pdf > 0)) return {L, 0, {}};
    return {L, pdf, brdf.evaluate(V, L) * (L.z / pdf)};
}

}  // namespace detail

/// A perfectly diffuse surface: f = albedo / pi, sampled in proportion to the cosine.
struct LambertBrdf {
    Vec3f albedo{1, 1, 1};  ///< [0, 1]

    Vec3f evaluate(const Vec3f& V, const Vec3f& L) const {
        return detail::above(V, L) ? albedo * float(1 / k_pi) : Vec3f{};
    }
    float pdf_solid_angle(const Vec3f& V, const Vec3f& L) const {
        return detail::above(V, L) ? L.z * float(1 / k_pi) : 0;
    }
    BrdfSample sample(const Vec3f& V, UnitPoint u) const {
        return detail::with_density(*this, V, cosine_hemisphere(u));
    }
};

/// The modified Phong BRDF, f = specular (n + 2) / (2 pi) max(cos, 0)^n, with the angle between L and the mirror
/// direction of V: Lafortune and Willems 1994. Sampled with density (n + 1) / (2 pi) cos^n.
struct PhongBrdf {
    float exponent = 1;       ///< n >= 0
    Vec3f specular{1, 1, 1};  ///< [0, 1]; the albedo at normal incidence

    Vec3f evaluate(const Vec3f& V, const Vec3f& L) const {
        return detail::above(V, L) ? specular * ((exponent + 2) * lobe(V, L)) : Vec3f{};
    }
    float pdf_solid_angle(const Vec3f& V, const Vec3f& L) const {
        return detail::above(V, L) ? (exponent + 1) * lobe(V, L) : 0;
    }
    BrdfSample sample(const Vec3f& V, UnitPoint u) const {
        // cos = (1 - u)^(1 / (n + 1)); computed as 1 - cos by expm1, so that narrow lobes keep their digits
        const float q = -std::expm1(std::log1p(-unit_float(u.x)) / (exponent + 1)), s = std::sqrt(q * (2 - q));
        const CirclePoint azimuth = circle_point(u.y);
        const Vec3f L = Frame<float>({-V.x, -V.y, V.z}).to_world({s * azimuth.x, s * azimuth.y, 1 - q});
        const float pdf = pdf_solid_angle(V, L);
        if (!(pdf > 0)) return {L, 0, {}};
        return {L, pdf, specular * ((exponent + 2) / (exponent + 1) * L.z)};
    }

  private:
    /// cos^n / (2 pi) about the mirror direction, from the squared distance to it: 1 - cos keeps its digits.
    float lobe(const Vec3f& V, const Vec3f& L) const {
        const Vec3f apart{L.x + V.x, L.y + V.y, L.z - V.z};
        const float one_minus = 0.5f * dot(apart, apart);
        if (!(one_minus < 1)) return 0;
        return std::exp(exponent * std::log1p(-one_minus)) * float(0.5 / k_pi);
    }
};

/// How GgxBrdf draws the microfacet normal.
enum class GgxNormals {
    half_vectors,  ///< D NdotH, the classic form (Walter et al. 2007): pdf = D NdotH / (4 VdotH)
    heitz,         ///< visible normals (Heitz 2018): pdf = G1 D / (4 NdotV)
    caps,          ///< the same density by spherical caps (Dupuy and Benyoub 2023)
    bounded_caps,  ///< the same without most normals that reflect into the surface (Eto and Tokuyoshi 2023): the
                   ///< default
};

/// Specular reflection by GGX microfacets, f = F D G2 / (4 NdotL NdotV), height-correlated Smith, Schlick's Fresnel.
template <GgxNormals normals = GgxNormals::bounded_caps>
struct BasicGgxBrdf {
    float alpha = 1;     ///< roughness^2, [0, 1]; raised to k_least_brdf_alpha at least
    Vec3f f0{1, 1, 1};   ///< reflectance at normal incidence, [0, 1]
    Vec3f f90{1, 1, 1};  ///< reflectance at grazing incidence

    Vec3f evaluate(const Vec3f& V, const Vec3f& L) const {
        if (!detail::above(V, L)) return {};
        const Vec3f H = V + L;
        return fresnel(H) * (ggx_d(H, width()) * ggx_visibility(L.z, V.z, width()));
    }
    float pdf_solid_angle(const Vec3f& V, const Vec3f& L) const {
        if (!detail::above(V, L)) return 0;
        const Vec3f H = V + L;
        return ggx_d(H, width()) / normals_per_density(V, H);
    }
    BrdfSample sample(const Vec3f& V, UnitPoint u) const {
        if (!(V.z >= 0)) return {V, 0, {}};
        const Vec3f L = reflect_about(V, draw(V, u));
        if (!detail::above(V, L)) return {L, 0, {}};
        const Vec3f H = V + L;
        const float ratio = normals_per_density(V, H);
        // f cos / pdf: D cancels
        return {L, ggx_d(H, width()) / ratio, fresnel(H) * (ratio * L.z * ggx_visibility(L.z, V.z, width()))};
    }

  private:
    float width() const { return std::max(alpha, k_least_brdf_alpha); }
    Vec3f fresnel(const Vec3f& H) const {
        return fresnel_schlick(0.5f * std::sqrt(dot(H, H)), f0, f90);  // |V + L| = 2 VdotH
    }
    /// D / pdf_solid_angle. H = V + L need not have unit length.
    float normals_per_density(const Vec3f& V, const Vec3f& H) const {
        if (normals == GgxNormals::half_vectors) return 2 * dot(H, H) / H.z;  // 4 VdotH / NdotH
        // 4 V.z / G1 = 2 (V.z + root), which is also right for V.z = 0; with the bound of the cap that draw() uses
        const float bound = normals == GgxNormals::bounded_caps ? ggx_cap_bound(V, width()) : 1;
        return 2 * (bound * V.z + ggx_smith_root(V.z, width()));
    }
    Vec3f draw(const Vec3f& V, UnitPoint u) const {
        switch (normals) {
            case GgxNormals::half_vectors:
                return ggx_half_vector(width(), u);
            case GgxNormals::heitz:
                return ggx_visible_normal_heitz(V, width(), u);
            case GgxNormals::caps:
                return ggx_visible_normal_cap(V, width(), u);
            case GgxNormals::bounded_caps:
                break;
        }
        return ggx_visible_normal_cap(V, width(), u, ggx_cap_bound(V, width()));
    }
};
using GgxBrdf = BasicGgxBrdf<>;

/// Sheen: f = colour D Vis with the Charlie distribution (Estevez and Kulla 2017) and Neubelt and Pettineo's
/// visibility, as in glTF's KHR_materials_sheen. Sampled by half vectors, pdf = D NdotH / (4 VdotH), as in the Khronos
/// tools.
///
/// The weight is 4 Vis NdotL VdotH / NdotH. At grazing view directions it grows like 1 / NdotH, and cosine sampling is
/// no worse there. With small alpha the model itself reflects more than it receives at grazing angles: its albedo
/// reaches 1.34 at alpha = 0.1, 0.93 at 0.25 and 0.63 at 1.
struct CharlieBrdf {
    float alpha = 1;        ///< roughness^2, [0, 1]; raised to k_least_charlie_alpha at least
    Vec3f colour{1, 1, 1};  ///< [0, 1]

    /// For smaller alphas D is a spike at the horizon from which no light is reflected.
    static constexpr float k_least_charlie_alpha = 1e-3f;

    Vec3f evaluate(const Vec3f& V, const Vec3f& L) const {
        return detail::above(V, L) ? colour * (distribution(V + L) * sheen_visibility(L.z, V.z)) : Vec3f{};
    }
    float pdf_solid_angle(const Vec3f& V, const Vec3f& L) const {
        if (!detail::above(V, L)) return 0;
        const Vec3f H = V + L;
        return distribution(H) * H.z / (2 * dot(H, H));
    }
    BrdfSample sample(const Vec3f& V, UnitPoint u) const {
        return detail::with_density(*this, V, reflect_about(V, charlie_half_vector(width(), u)));
    }

  private:
    float width() const { return std::max(alpha, k_least_charlie_alpha); }
    float distribution(const Vec3f& H) const {
        const float sin2 = H.x * H.x + H.y * H.y;
        return charlie_d(sin2 / (sin2 + H.z * H.z), width());
    }
};

}  // namespace domelight
