#pragma once

#include "domelight/bake/bake.h"

#include <span>
#include <string>

namespace domelight {

/// Windows the coefficients, derives those of the irradiance E and measures them against the exact map of E / pi, texel
/// by texel.
ShReport make_sh_report(std::span<const Vec3d> radiance, int bands, ShWindow window,
                        const FilteredMap& irradiance_over_pi, int threads);

/// Filament's nine numbers in the lines of its sh.txt.
std::string filament_sh_text(const ShReport& sh);
/// The same as the value of the key "sh".
std::string filament_sh_metadata(const ShReport& sh);

}  // namespace domelight
