#pragma once
// The transpose of the filter, for optimisation: prefilter() is linear in the environment, so the gradient of a loss with
// respect to the environment is the transpose of the filter, applied to the gradient with respect to the filtered maps.
//
//     auto filtered = prefilter(rows, options);               // y = A x
//     FilterResult gradient = ...;                            // dloss/dy, of the same shapes
//     auto of_environment = prefilter_transpose(width, height, gradient, options);  // dloss/dx = Aᵀ dloss/dy

#include "domelight/base/result.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/image/image.h"

namespace domelight {

/// Aᵀ y, where A is prefilter() for a lat-long image in the default convention: ⟨A x, y⟩ = ⟨x, Aᵀ y⟩, with plain sums
/// over texels and channels on both sides. What prefilter() does beside that is not linear and has no transpose here:
/// that values which come out negative are set to 0, and the rounding of its expansions (each about 1e-6).
///
/// width, height   of the lat-long image x
/// values          y: `specular`, `irradiance_over_pi` and `sh`, as prefilter() gives them for the options. Each map may
///                 be empty, which stands for 0; so may `sh`. Any sign
/// options         of the filter. Texels must be `centre`, and no level the environment itself. Of `progress`, nothing
///                 is told
/// returns         width x height, 3 channels
///
/// Errors: those of check_filter_options(); a map of another size than its level; a level that is the environment itself;
/// texels `read`; no texels.
Result<ImageF> prefilter_transpose(int width, int height, const FilterResult& values, const FilterOptions& options);

}  // namespace domelight
