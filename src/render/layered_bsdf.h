#pragma once
// The lobes that few materials have, over and beside the base of bsdf.h: KHR_materials_anisotropy, _transmission and
// _volume change the base; _sheen lies on it, _clearcoat on both.

#include "domelight/base/frame.h"

#include "render/surface/bsdf.h"
#include "render/surface/lobe_interface.h"
#include "render/surface/lobe_sheen.h"

namespace domelight {

/// One point of a surface of a material that has any of them.
///
/// Each layer takes from those below what it sends back itself, seen from V: (1 - its albedo at V). glTF's clearcoat
/// has 1 - clearcoat F(NdotV), which is the same for a smooth coat; with the albedo (of the BRDF table) no roughness
/// makes light, and a white base under a layer stays white in a white furnace. The price is reciprocity: of the whole,
/// not of the layers. It is what glTF's sheen does ("albedo scaling") and what multiple scattering does below.
///
/// Below, with its tint t = transmission and metalness m: F gloss + (1 - F)(1 - m)((1 - t) diffuse + t base
/// transmitted).
struct LayeredBsdf {
    static constexpr float k_coat_f0 = 0.04f;  ///< KHR_materials_clearcoat: an index of 1.5

    Bsdf base;                        ///< diffuse: less what is transmitted
    Vec3f geometric_normal{0, 0, 1};  ///< local: which side light comes from

    // The base's microfacets, where they are not round or let light through.
    bool elliptic = false;
    float tangent_x = 1, tangent_y = 0;  ///< local: the direction of `gloss.ggx`'s x
    InterfaceLobe gloss;                 ///< with `transmits` both sides of it, else only its ggx
    bool transmits = false;
    Vec3f transmitted;          ///< tint of what goes through; multiple scattering included
    Vec3f clear_f0, clear_f90;  ///< what does not go through
    Vec3f gloss_gain{1, 1, 1};  ///< multiple scattering
    bool volume = false;        ///< the boundary of a body
    Vec3f absorption;           ///< volume: 1 / metre
    float thickness = 0;        ///< volume: metres, where no other side of it is found

    Vec3f sheen_colour;
    SheenLobe sheen;
    float under_sheen = 1;  ///< of the light below it

    float coat = 0;
    float coat_alpha = 1;
    Frame<float> coat_frame{Vec3f{0, 0, 1}};  ///< local
    float under_coat = 1;

    /// For sampling: the parts' shares, summing to 1.
    float coat_share = 0, sheen_share = 0, diffuse_share = 0, gloss_share = 1;

    /// What part of the light of the base, its emission included, passes the layers over it.
    float under() const { return under_sheen * under_coat; }
    /// Share of the light left after `distance` metres inside.
    Vec3f through(float distance) const;

    /// In the frame of `gloss`.
    Vec3f to_tangent(const Vec3f& v) const {
        return {tangent_x * v.x + tangent_y * v.y, tangent_x * v.y - tangent_y * v.x, v.z};
    }

    /// Makes the shares, when all else is set; V: local.
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
