#pragma once

#include "domelight/sampling/light_extraction.h"

#include <array>
#include <span>
#include <string>

namespace domelight {

/// The unit quaternion (x, y, z, w) of the shortest turn that takes -Z to `direction` (unit length).
std::array<double, 4> turn_from_minus_z(const Vec3d& direction);

/// A glTF 2.0 document (JSON, UTF-8) with one node and one KHR_lights_punctual light of type "directional" for each
/// light.
///
/// glTF's directional light shines along its node's -Z, so a node turns -Z to the way the light travels, away from its
/// direction here. Its illuminance in channel c is intensity x colour_c lux: `intensity` is what it would be "if it
/// were colored pure white", and so the largest channel of the irradiance times `lux_per_unit`, with `color` the
/// irradiance over that channel.
///
/// lux_per_unit  lux for an irradiance of 1 in the environment's unit: 1 where that is photometric (cd / m^2) or
///               relative; lm / W where it is in watts. It is written into the extras of the asset and of each light,
///               beside that light's diameter and irradiance, so that a reader finds the environment's unit again
/// rotate_y_deg  how far the environment was turned about +Y when the lights were found; it is written into the extras
///               of the asset, so that a reader that turns the environment by another angle can turn the lights too
std::string gltf_lights(std::span<const ExtractedLight> lights, double lux_per_unit, double rotate_y_deg,
                        const std::string& generator);

}  // namespace domelight
