#pragma once
// Reads a material's layers at a point: glTF's anisotropy, transmission, volume, sheen and clearcoat.

#include "render/layered_bsdf.h"
#include "render/surface/surface_corners.h"

namespace domelight {

/// Whether a material can have any of them.
bool has_layers(const Material& m);
/// Whether any material of the scene can.
bool has_layers(const Scene& scene);

/// The inputs for the layers of a point.
struct LayerInputs {
    const Scene& scene;
    const Instance& instance;
    const Material& material;
    const Corners& corners;
    Vec3f view;           ///< towards the viewer, in the world
    Vec3f normal;         ///< as lit
    Vec3f smooth_normal;  ///< before the normal map, on the viewer's side
    Vec3f geometric_normal;
    bool front;
    Vec3f base;  ///< colour
    float metalness, roughness;
    Vec3f dielectric_f0, dielectric_f90;
    bool multiple_scattering;
    UnitPoint shift;  ///< for interface_albedo()
};

/// Fills `out`, whose `base` is the surface without layers. Returns false if there are no layers at this point.
bool make_layers(const LayerInputs& in, LayeredBsdf& out);

}  // namespace domelight
