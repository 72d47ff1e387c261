#pragma once

#include "domelight/prefilter.h"

namespace domelight {

/// The plain, slow filters: what the exact one is tested against and what a reader learns from.
enum class ReferenceMethod {
    bruteforce,  ///< the kernel summed over all of the source, patch by patch, in double: the truth
    riemann,     ///< the textbook Riemann sum over the hemisphere about each direction, K x J steps
    montecarlo,  ///< Hammersley points, GGX half vectors, weighted by n.l: Karis 2013
};

struct ReferenceOptions {
    ReferenceMethod method = ReferenceMethod::bruteforce;
    int riemann_polar = 64, riemann_azimuth = 256;  ///< K and J
    int samples = 1024;                             ///< montecarlo: per texel
};

/// The same result as `prefilter`, by a plain method, from a lat-long image in memory.
Result<FilterResult> prefilter_reference(ImageView<const float> latlong, const FilterOptions& options, const ReferenceOptions& reference = {});

/// The truth for single directions: the kernel integrated in double over the bilinear reconstruction (2 x 2 Gauss-Legendre nodes a patch, 3 x 3
/// where the kernel is narrower than 4 texels). `directions` are in the source's frame.
std::vector<Vec3d> convolve_exactly(ImageView<const float> latlong, const ZonalKernel& kernel, std::span<const Vec3d> directions, int threads = 0);

}  // namespace domelight
