#pragma once
// What is seen where there is no surface.

#include "domelight/render/shading/shading.h"

namespace domelight {

/// Errors: a blurred background without maps.
inline Result<void> check_background(const RenderOptions& o) {
    if (o.background != Background::blurred || o.background_maps) return {};
    return Error{"a blurred background has no maps to be read from", "", "Set RenderOptions::background_maps."};
}

/// Radiance of the background in a direction (unit length).
inline Vec3f background_radiance(const RenderOptions& o, const EnvironmentSampler& environment,
                                 const Vec3f& direction) {
    switch (o.background) {
        case Background::environment:
            return environment.radiance(direction);
        case Background::blurred:
            return o.background_maps->specular(direction, o.background_roughness);
        case Background::colour:
            return o.background_colour;
        case Background::transparent:
            break;
    }
    return {};
}

}  // namespace domelight
