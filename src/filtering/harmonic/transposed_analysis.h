#pragma once

#include "domelight/image/image.h"

#include "filtering/harmonic/sphere_grid.h"

namespace domelight {

/// The transpose of ShAnalysis, for functions that are known on its rings: adds to each texel of a lat-long image the
/// integral of the function over the sphere, times the texel's tent (the bilinear weight that the reconstruction gives
/// the texel).
///
/// function     on the grid of ring_grid_for(band_limit), wrapped; its spectrum has decayed at the band limit
/// band_limit   its highest degree
/// image        3 channels
void add_tent_integrals(const SphereGrid& function, int band_limit, ImageView<float> image, int threads);

}  // namespace domelight
