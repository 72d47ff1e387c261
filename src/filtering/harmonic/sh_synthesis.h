#pragma once

#include "filtering/harmonic/ring_transform.h"
#include "filtering/harmonic/spectrum.h"
#include "filtering/harmonic/sphere_grid.h"

#include <span>
#include <vector>

namespace domelight {

/// A function Σ_lm k_l a_lm Y_lm, plus Σ_lm r_l b_lm Y_lm if there are factors r.
struct SynthesisFactors {
    std::vector<double> k;  ///< of degrees 0 .. band limit
    std::vector<double> r;  ///< of at most as many degrees; may be empty
};

/// Such functions on the rings of one grid. The Legendre functions are computed once for all of them.
///
/// a, b      spectra of at least as many degrees as the factors; b may be null if no function has factors r
/// factors   of each function; all k of the same band limit
/// with      grid_transform() of that band limit
std::vector<SphereGrid> sh_synthesis(const Spectrum& a, const Spectrum* b, std::span<const SynthesisFactors> factors,
                                     const RingTransform& with, int threads);

}  // namespace domelight
