#pragma once
// The lobes that few materials have, in addition to the base of bsdf.h: KHR_materials_anisotropy, _transmission and
// _volume change the base; _sheen is a layer over it, and _clearcoat a layer over both.

#include "domelight/base/frame.h"

#include "render/surface/bsdf.h"
#include "render/surface/lobe_interface.h"
#include "render/surface/lobe_sheen.h"

namespace domelight {

/// One point of a surface whose material has any of them.
///
/// Each layer scales the layers below it by 1 minus its own albedo, seen from V. glTF's clearcoat has 1 - clearcoat
/// F(NdotV), which is the same for a smooth coat. With the albedo (from the BRDF table) no energy is gained at any
/// roughness, and a white base under a layer stays white in a white furnace. The price is that the whole is not
/// reciprocal, though each layer is. glTF's sheen does the same ("albedo scaling"), and so does multiple scattering
/// below.
///
/// Below, with its tint t = transmission and metalness m: F gloss + (1 - F)(1 - m)((1 - t) diffuse + t base
/// transmitted).
struct LayeredBsdf {
    static constexpr float k_coat_f0 = 0.04f;  ///< KHR_materials_clearcoat: an index of 1.5

    Bsdf base;                        ///< diffuse: less what is transmitted
    Vec3f geometric_normal{0, 0, 1};  ///< local: which side light comes from

    // The microfacets of the base, if they are anisotropic or transmit light.
    bool elliptic = false;
    float tangent_x = 1, tangent_y = 0;  ///< local: the direction of `gloss.ggx`'s x
    InterfaceLobe gloss;                 ///< all of it if `transmits`, otherwise only its ggx
    bool transmits = false;
    Vec3f transmitted;          ///< tint of transmitted light; multiple scattering included
    Vec3f clear_f0, clear_f90;  ///< the part that is not transmitted
    Vec3f gloss_gain{1, 1, 1};  ///< multiple scattering
    bool volume = false;        ///< the boundary of a body
    Vec3f absorption;           ///< volume: 1 / metre
    float thickness = 0;        ///< volume: metres, used if no other side of the body is found

    Vec3f sheen_colour;
    SheenLobe sheen;
    float under_sheen = 1;  ///< the factor for the light below it

    float coat = 0;
    float coat_alpha = 1;
    Frame<float> coat_frame{Vec3f{0, 0, 1}};  ///< local
    float under_coat = 1;

    /// For sampling: the probability of each part; they sum to 1.
    float coat_share = 0, sheen_share = 0, diffuse_share = 0, gloss_share = 1;

    /// The part of the base's light, including its emission, that passes the layers over it.
    float under() const { return under_sheen * under_coat; }
    /// The part of the light that is left after `distance` metres inside.
    Vec3f through(float distance) const;

    /// In the frame of `gloss`.
    Vec3f to_tangent(const Vec3f& v) const {
        return {tangent_x * v.x + tangent_y * v.y, tangent_x * v.y - tangent_y * v.x, v.z};
    }

    /// Computes the probabilities, after everything else is set; V: local.
    void share_out(const Vec3f& V);

    /// f times the cosine, since layers have normals of their own; L on either side.
    Bsdf::Value evaluate_cosine(const Vec3f& V, const Vec3f& L) const;
    float pdf_solid_angle(const Vec3f& V, const Vec3f& L) const;
    /// `choice` in [0, 1). A density of 0: nothing was drawn.
    Bsdf::Sample sample(const Vec3f& V, UnitPoint u, float choice) const;

  private:
    bool own_gloss() const { return elliptic || transmits; }
    Vec3f from_tangent(const Vec3f& v) const {
        return {tangent_x * v.x - tangent_y * v.y, tangent_x * v.y + tangent_y * v.x, v.z};
    }
    Bsdf::Value evaluate_base(const Vec3f& V, const Vec3f& L) const;
    float pdf_gloss(const Vec3f& V, const Vec3f& L) const;
};

}  // namespace domelight
