#pragma once
// The engines, one a file.

#include "domelight/engines/engine.h"

namespace domelight {

Engine generic_engine();
Engine khronos_engine();
Engine filament_engine();
Engine babylon_engine();
Engine bevy_engine();
Engine three_engine();
Engine three_latlong_engine();
Engine playcanvas_engine();
Engine gltf_engine();
Engine godot_engine();
Engine unity_engine();
Engine unreal_engine();
Engine blender_engine();
Engine mitsuba_engine();
Engine pbrt_engine();
Engine usd_engine();
Engine materialx_engine();

/// For engines that read level = (levels - 1) r (2 - r), Filament and three.js: r = 1 - sqrt(1 - level / (levels -
/// 1)).
double quadratic_roughness(double level, int levels, int size);

}  // namespace domelight
