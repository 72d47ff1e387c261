#pragma once
// How much of the light a lobe sends back in all, seen from one direction.

#include "render/surface/lobe_interface.h"

namespace domelight {

/// The BRDF table (brdf_table.h) between its texels.
struct TableAlbedo {
    float scale = 0, bias = 0;  ///< GGX with Schlick's Fresnel: f0 scale + f90 bias
    float sheen = 0;            ///< the Charlie lobe
    float all() const { return scale + bias; }
};
TableAlbedo table_albedo(float NdotV, float roughness);

/// What the microfacets of a boundary reflect and let through, without the light that they pass on to each other:
/// reflected + transmitted <= 1. Linear in f0 and f90; the lobe's own are not used.
struct InterfaceAlbedo {
    float total = 0;                            ///< reflected beyond the critical angle
    float reflect_scale = 0, reflect_bias = 0;  ///< of f0 and f90
    float clear = 0, clear_scale = 0, clear_bias = 0;

    float reflected(float f0, float f90) const { return total + f0 * reflect_scale + f90 * reflect_bias; }
    float transmitted(float f0, float f90) const { return clear - f0 * clear_scale - f90 * clear_bias; }
};
/// A mean over 89 of the normals that V sees, moved by `shift`: right to 1 %, and exact in the mean over all
/// shifts. So a picture, whose samples each have one of their own, has no error from it.
InterfaceAlbedo interface_albedo(const InterfaceLobe& lobe, const Vec3f& V, UnitPoint shift);

}  // namespace domelight
