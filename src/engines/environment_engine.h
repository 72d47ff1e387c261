#pragma once

#include "domelight/engines/engine.h"

#include <utility>

namespace domelight {

/// An engine that filters or samples by itself: the environment alone, in its own size, one half-float .exr.
inline Engine environment_engine(std::string name, std::string loads, std::string panorama) {
    Engine e;
    e.name = std::move(name);
    e.loads = std::move(loads);
    e.roughness = linear_roughness;
    e.container = Container::exr;
    e.size = 0;
    e.environment_only = true;
    e.panorama = std::move(panorama);
    e.specular_file = "{stem}";
    e.irradiance_file = "";
    e.brdf_file = "";
    e.brdf_form = BrdfForm::none;
    return e;
}

}  // namespace domelight
