#pragma once
// The reflection of a surface at one point: a Lambert layer below a GGX or Phong layer, mixed as in glTF's
// metallic-roughness model.

#include "domelight/sampling/brdf.h"

namespace domelight {

/// A BRDF in the local frame of brdf.h, with separate lobes.
struct Bsdf {
    enum class Kind : std::uint8_t { lambert, metallic_roughness, phong };
    Kind kind = Kind::lambert;
    bool separable_masking = false;       ///< G1 G1 instead of G2
    Vec3f diffuse;                        ///< albedo of the lower layer
    Vec3f f0, f90;                        ///< of the microfacets; phong: specular is f0
    Vec3f dielectric_f0, dielectric_f90;  ///< of the layer over `diffuse`
    float alpha = 1;                      ///< GGX
    float exponent = 1;                   ///< Phong
    float compensation = 0;               ///< multiple scattering: (1 - E) / E at the viewer's angle, 0 without
    float specular_share = 0;             ///< the probability of sampling the specular lobe

    struct Value {
        Vec3f diffuse, specular;
        Vec3f sum() const { return diffuse + specular; }
    };

    /// f without the cosine.
    Value evaluate(const Vec3f& V, const Vec3f& L) const {
        if (!detail::above(V, L)) return {};
        Value value;
        switch (kind) {
            case Kind::lambert:
                value.diffuse = diffuse * float(1 / k_pi);
                break;
            case Kind::metallic_roughness: {
                const Vec3f H = V + L;
                const float VdotH = 0.5f * std::sqrt(dot(H, H)), schlick = schlick_weight(VdotH);
                const Vec3f under = dielectric_f0 + (dielectric_f90 - dielectric_f0) * schlick;
                // glTF 2.0, B.3.4: light that the layer above reflects does not reach the layer below.
                value.diffuse = diffuse * ((1 - std::max({under.x, under.y, under.z})) * float(1 / k_pi));
                const float visibility =
                    separable_masking ? ggx_visibility_separable(L.z, V.z, alpha) : ggx_visibility(L.z, V.z, alpha);
                const float gloss = ggx_d(H, alpha) * visibility;
                const Vec3f fresnel = f0 + (f90 - f0) * schlick;
                const Vec3f more{1 + f0.x * compensation, 1 + f0.y * compensation, 1 + f0.z * compensation};
                value.specular = Vec3f{fresnel.x * more.x, fresnel.y * more.y, fresnel.z * more.z} * gloss;
                break;
            }
            case Kind::phong:
                value.diffuse = diffuse * float(1 / k_pi);
                value.specular = PhongBrdf{exponent, f0}.evaluate(V, L);
                break;
        }
        return value;
    }

    float pdf_solid_angle(const Vec3f& V, const Vec3f& L) const {
        float pdf = specular_share < 1 ? (1 - specular_share) * LambertBrdf{}.pdf_solid_angle(V, L) : 0;
        if (specular_share > 0)
            pdf += specular_share * (kind == Kind::phong ? PhongBrdf{exponent}.pdf_solid_angle(V, L)
                                                         : GgxBrdf{alpha}.pdf_solid_angle(V, L));
        return pdf;
    }

    struct Sample {
        Vec3f L;
        float pdf_solid_angle = 0;  ///< 0: nothing was drawn
    };
    Sample sample(const Vec3f& V, UnitPoint u) const {
        // One number chooses the lobe, is rescaled, and is used again.
        Vec3f L;
        if (specular_share >= 1) {
            L = specular(V, u);
        } else {
            const auto edge = std::uint32_t(double(specular_share) * 0x1p32);
            if (u.x < edge) {
                u.x = std::uint32_t((std::uint64_t(u.x) << 32) / edge);
                L = specular(V, u);
            } else {
                const std::uint64_t rest = (std::uint64_t(1) << 32) - edge;
                u.x = std::uint32_t((std::uint64_t(u.x - edge) << 32) / rest);
                L = cosine_hemisphere(u);
            }
        }
        return {L, pdf_solid_angle(V, L)};
    }

  private:
    Vec3f specular(const Vec3f& V, UnitPoint u) const {
        return kind == Kind::phong ? PhongBrdf{exponent}.sample(V, u).L : GgxBrdf{alpha}.sample(V, u).L;
    }
};

}  // namespace domelight
