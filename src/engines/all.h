#pragma once
// The targets, one a file.

#include "domelight/engines/engine.h"

namespace domelight {

Target generic_target();
Target khronos_target();
Target filament_target();
Target babylon_target();
Target bevy_target();
Target three_target();
Target three_latlong_target();
Target playcanvas_target();
Target gltf_target();
Target godot_target();
Target unity_target();
Target unreal_target();
Target blender_target();
Target mitsuba_target();
Target pbrt_target();
Target usd_target();
Target materialx_target();

/// For consumers that read level = (levels - 1) r (2 - r), Filament and three.js: r = 1 - sqrt(1 - level / (levels -
/// 1)).
double quadratic_roughness(int level, int levels, int size);

}  // namespace domelight
