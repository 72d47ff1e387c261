#pragma once
// A light without size, as a point receives it.

#include "domelight/render/render.h"

#include <algorithm>
#include <cmath>

namespace domelight {

struct PunctualArrival {
    Vec3f direction;  ///< to the light, unit length
    float distance = std::numeric_limits<float>::infinity();
    float strength = 0;  ///< the irradiance perpendicular to it is `strength` times the light's intensity; 0: no light
                         ///< arrives
};

/// KHR_lights_punctual: the inverse-square law, the falloff to 0 at the range ("Range property"), and the edge of a
/// spot light ("Inner and outer cone angles").
inline PunctualArrival arrival_at(const PunctualLight& light, const Vec3f& position) {
    PunctualArrival a;
    if (light.kind == PunctualLight::Kind::directional) {
        a.direction = -light.direction;
        a.strength = 1;
        return a;
    }
    const Vec3f to = light.position - position;
    const float squared = dot(to, to);
    a.distance = std::sqrt(squared);
    if (!(a.distance > 0)) return a;
    a.direction = to / a.distance;
    const float part = a.distance / light.range;
    a.strength = std::clamp(1 - part * part * part * part, 0.f, 1.f) / squared;
    if (light.kind == PunctualLight::Kind::spot) {
        const float cosine = -dot(a.direction, light.direction);
        const float edge =
            std::clamp((cosine - light.cos_outer) / std::max(0.001f, light.cos_inner - light.cos_outer), 0.f, 1.f);
        a.strength *= edge * edge;
    }
    return a;
}

/// The scene's own lights, and those that were taken out of the environment.
inline std::vector<PunctualLight> all_lights(const Scene& scene, const RenderOptions& options) {
    std::vector<PunctualLight> lights = scene.lights;
    lights.insert(lights.end(), options.environment_lights.begin(), options.environment_lights.end());
    return lights;
}

}  // namespace domelight
