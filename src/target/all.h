#pragma once
// The targets, one a file.

#include "domelight/target.h"

namespace domelight {

Target generic_target();
Target khronos_target();
Target filament_target();
Target babylon_target();
Target bevy_target();
Target three_target();

}  // namespace domelight
