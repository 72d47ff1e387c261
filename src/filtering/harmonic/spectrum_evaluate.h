#pragma once

#include "domelight/base/vec.h"

#include "filtering/harmonic/spectrum.h"

#include <vector>

namespace domelight {

/// The expansion's value in a direction of the source's frame, degrees 0..band_limit (at most the spectrum's), each
/// degree times factors[l] (none: 1). Plain and slow, in double: the synthesis is tested against it, and it is used for
/// a few directions.
Vec3d evaluate_spectrum(const Spectrum& spectrum, const Vec3d& direction, int band_limit,
                        const std::vector<double>& factors = {});

/// Real coefficients in world space (basis of spherical_harmonics.h) of the first `bands` bands.
std::vector<Vec3d> spectrum_to_sh(const Spectrum& spectrum, int bands, const Mat3& world_to_source);

}  // namespace domelight
