#pragma once

#include "filtering/harmonic/spectrum.h"
#include "filtering/harmonic/sphere_grid.h"

#include <span>
#include <vector>

namespace domelight {

/// The functions sum_lm k_l a_lm Y_lm on the rings of one grid, one for each list of factors (k_0 .. k_band_limit; all
/// of the same length, at most the spectrum's). The Legendre functions are computed once for all of them.
std::vector<SphereGrid> sh_synthesis(const Spectrum& spectrum, std::span<const std::vector<double>> factors,
                                     RingGrid grid, int threads);

}  // namespace domelight
