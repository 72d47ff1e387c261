#pragma once

#include "domelight/filtering/prefilter.h"
#include "domelight/sampling/sequences.h"

namespace domelight {

/// The plain, slow filters. The exact filter is tested against them, and they show the method in its simplest form.
enum class ReferenceMethod {
    bruteforce,  ///< the kernel summed over all of the source, patch by patch, in double: the reference
    riemann,     ///< the midpoint Riemann sum over the hemisphere about each direction
    montecarlo,  ///< half vectors drawn from the lobe, weighted by n.l: Karis 2013
};

/// The steps of the Riemann sum: K counts phi, J counts theta.
struct RiemannOptions {
    int phi_steps = 256;   ///< K: steps of the azimuth phi over [0, 2 pi)
    int theta_steps = 64;  ///< J: steps of the polar angle theta over [0, pi/2)
    /// Whether the sum is divided by the sum of its weights, so that constant light stays constant. Without the
    /// division the irradiance E is the double sum pi^2 / (K J) sum L cos theta sin theta, which is 3.224 instead of pi
    /// for L = 1 and J = 4.
    bool normalised = true;
};

struct ReferenceOptions {
    ReferenceMethod method = ReferenceMethod::bruteforce;
    RiemannOptions riemann = {};
    PointSet points = {};  ///< montecarlo: the sample points, the same for every texel
};

/// The same result as `prefilter`, by a plain method, from a lat-long image in memory.
Result<FilterResult> prefilter_reference(ImageView<const float> latlong, const FilterOptions& options,
                                         const ReferenceOptions& reference = {});

/// The reference values for single directions: the kernel integrated in double over the bilinear reconstruction, patch
/// by patch with 2 x 2 Gauss-Legendre nodes. Near the peak, at the horizon and in small images, patches are halved
/// until 4 x 4 nodes are enough. A constant stays constant to 1e-7. `directions` are of unit length and in the source's
/// frame.
std::vector<Vec3d> convolve_exactly(ImageView<const float> latlong, const ZonalKernel& kernel,
                                    std::span<const Vec3d> directions, int threads = 0);

}  // namespace domelight
