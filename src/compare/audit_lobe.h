#pragma once
// The width of any lobe, expressed as a roughness. An audit searches over this number.

#include "domelight/filtering/kernel/zonal_kernel.h"

namespace domelight {

/// A Phong lobe cos^n is about as wide as GGX at this roughness: n = (1 / roughness^4 - 1) / 2. 0 for an infinite n.
double roughness_of_exponent(double exponent);
/// Infinite at roughness 0.
double exponent_of_roughness(double roughness);

/// The kernel of this lobe at a roughness in (0, 1].
ZonalKernel lobe_at_roughness(Lobe lobe, double roughness);

/// Whether filtering at roughness 0 gives the environment itself. False for Charlie only: its lobe narrows towards the
/// horizon of the hemisphere, not towards the normal.
bool starts_at_mirror(Lobe lobe);

}  // namespace domelight
