#pragma once

#include "domelight/engines/engine.h"

#include <utility>

namespace domelight {

/// A consumer that filters or samples by itself: the environment alone, one half-float .exr.
inline Target environment_target(std::string name, std::string consumer, std::string panorama) {
    Target t;
    t.name = std::move(name);
    t.consumer = std::move(consumer);
    t.roughness = linear_roughness;
    t.container = Container::exr;
    t.environment_only = true;
    t.panorama = std::move(panorama);
    t.specular_file = "{stem}";
    t.irradiance_file = "";
    t.brdf_file = "";
    t.brdf_form = BrdfForm::none;
    return t;
}

}  // namespace domelight
