#pragma once
// The albedo of a lobe: the part of the light that it reflects in all, for one view direction.

#include "render/surface/lobe_interface.h"

namespace domelight {

/// The BRDF table (brdf_table.h), interpolated between its texels.
struct TableAlbedo {
    float scale = 0, bias = 0;  ///< GGX with Schlick's Fresnel: f0 scale + f90 bias
    float sheen = 0;            ///< the Charlie lobe
    float all() const { return scale + bias; }
};
TableAlbedo table_albedo(float NdotV, float roughness);

/// The reflected and the transmitted part of the light at the microfacets of a boundary, without light scattered
/// between microfacets: reflected + transmitted <= 1. Linear in f0 and f90; those of the lobe are not used.
struct InterfaceAlbedo {
    float total = 0;                            ///< reflected beyond the critical angle
    float reflect_scale = 0, reflect_bias = 0;  ///< of f0 and f90
    float clear = 0, clear_scale = 0, clear_bias = 0;

    float reflected(float f0, float f90) const { return total + f0 * reflect_scale + f90 * reflect_bias; }
    float transmitted(float f0, float f90) const { return clear - f0 * clear_scale - f90 * clear_bias; }
};
/// A mean over 89 normals visible from V, shifted by `shift`. It is right to 1 %, and exact in the mean over all
/// shifts. So a picture, in which each sample has a different shift, has no error from it.
InterfaceAlbedo interface_albedo(const InterfaceLobe& lobe, const Vec3f& V, UnitPoint shift);

}  // namespace domelight
