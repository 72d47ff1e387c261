#pragma once
// A rough boundary that transmits light: KHR_materials_transmission, and with KHR_materials_volume the boundary of a
// solid body.

#include "render/surface/lobe_fresnel.h"
#include "render/surface/lobe_ggx.h"

#include <optional>

namespace domelight {

/// Reflection and transmission by GGX microfacets, local frame with V above; transmitted L have L.z < 0.
///
/// If thin (without volume), light goes straight on and is spread like a reflection: the lobe is that of the reflection
/// mirrored at the surface (glTF, KHR_materials_transmission: "specular_btdf"). Otherwise each microfacet refracts by
/// Snell's law (Walter et al. 2007, eq. 21), and reflects all light beyond the critical angle.
///
/// Paths carry L / n^2, which refraction does not change, so there is no factor for the change of solid angle, and
/// weights are at most 1. For light that comes from outside and leaves again this makes no difference.
struct InterfaceLobe {
    EllipticGgx ggx;
    float eta = 1.5f;           ///< index beyond the surface over the one on V's side
    bool thin = true;           ///< straight on
    bool schlick = false;       ///< the Fresnel weight is Schlick's, as for opaque surfaces
    float reflect = 1;          ///< for sampling: the weight of the reflected part ...
    float transmit = 1;         ///< ... and of the transmitted part
    float f0 = 0.04f, f90 = 1;  ///< for sampling, and for the split of light: F = f0 + (f90 - f0) weight(VdotH)

    /// Weight of f90 over f0; 1 where nothing is transmitted.
    float weight(float VdotH) const { return schlick ? schlick_weight(VdotH) : fresnel_weight(VdotH, eta); }
    /// There is no refracted direction.
    bool total(float VdotH) const { return !thin && eta * eta - 1 + VdotH * VdotH <= 0; }
    float fresnel(float VdotH) const { return total(VdotH) ? 1 : f0 + (f90 - f0) * weight(VdotH); }

    struct Part {
        float value = 0;  ///< f without Fresnel's F or 1 - F, and without the cosine
        float VdotH = 0;
    };
    /// f of reflection, L.z > 0.
    Part reflection(const Vec3f& V, const Vec3f& L) const {
        if (!detail::above(V, L)) return {};
        const Vec3f H = V + L;
        return {ggx.distribution(H) * ggx.visibility(V, L), 0.5f * length(H)};
    }
    /// f of transmission, L.z < 0.
    Part transmission(const Vec3f& V, const Vec3f& L) const {
        if (thin) return reflection(V, {L.x, L.y, -L.z});
        const auto h = half_vector(V, L);
        if (!h) return {};
        // Walter et al. 2007, eq. 21, times eta^2 (see above); separable masking.
        const float G = ggx.masking(V) * ggx.masking(L);
        return {G * ggx.distribution(h->H) * h->VdotH * jacobian(*h) / (std::max(V.z, 1e-9f) * -L.z), h->VdotH};
    }

    float pdf_solid_angle(const Vec3f& V, const Vec3f& L) const {
        if (!(V.z >= 0)) return 0;
        if (L.z > 0) {
            if (!detail::above(V, L)) return 0;
            return ggx.pdf_reflected(V, L, bound(V)) * share_reflected(0.5f * length(V + L));
        }
        if (thin) {
            const Vec3f M{L.x, L.y, -L.z};
            if (!detail::above(V, M)) return 0;
            return ggx.pdf_reflected(V, M, bound(V)) * (1 - share_reflected(0.5f * length(V + M)));
        }
        const auto h = half_vector(V, L);
        if (!h) return 0;
        // Density of visible normals, 2 D VdotH / (V.z + root), times dH / dL.
        return 2 * ggx.distribution(h->H) * h->VdotH / (V.z + ggx.root(V)) * jacobian(*h) *
               (1 - share_reflected(h->VdotH));
    }
    /// `choice`: in [0, 1), decides whether the microfacet reflects. {0, 0, 0}: no direction, the light is lost in the
    /// surface.
    Vec3f sample(const Vec3f& V, UnitPoint u, float choice) const {
        const Vec3f H = normalize(ggx.draw(V, u, bound(V)));
        const float VdotH = dot(V, H);
        if (!(VdotH > 0)) return {};
        const bool reflected = choice < share_reflected(VdotH);
        if (reflected || thin) {
            const Vec3f L = H * (2 * VdotH) - V;
            return L.z > 0 ? Vec3f{L.x, L.y, reflected ? L.z : -L.z} : Vec3f{};
        }
        const float g2 = std::max(0.f, eta * eta - 1 + VdotH * VdotH);
        const Vec3f L = normalize(H * (VdotH - std::sqrt(g2)) - V);
        return L.z < 0 ? L : Vec3f{};
    }

  private:
    struct Half {
        Vec3f H;  ///< unit length
        float VdotH, LdotH;
    };
    /// The normal of the microfacet that refracts V to L: Walter et al. 2007, eq. 16.
    std::optional<Half> half_vector(const Vec3f& V, const Vec3f& L) const {
        if (!(V.z >= 0 && L.z < -k_least_cosine)) return std::nullopt;
        const Vec3f sum = V + L * eta;
        const float n = length(sum);
        if (!(n > 0)) return std::nullopt;
        const Vec3f H = sum * ((sum.z < 0 ? -1 : 1) / n);
        const Half h{H, dot(V, H), dot(L, H)};
        if (!(h.VdotH > 0 && h.LdotH < 0)) return std::nullopt;
        return h;
    }
    /// dH / dL: Walter et al. 2007, eq. 17.
    float jacobian(const Half& h) const {
        const float d = h.VdotH + eta * h.LdotH;
        return eta * eta * -h.LdotH / (d * d);
    }
    /// Normals that reflect below the surface need not be drawn, unless they can refract.
    float bound(const Vec3f& V) const { return thin ? ggx.cap_bound(V) : 1; }
    float share_reflected(float VdotH) const {
        const float F = fresnel(VdotH), r = reflect * F, t = transmit * (1 - F);
        return r + t > 0 ? r / (r + t) : 1;
    }
};

}  // namespace domelight
