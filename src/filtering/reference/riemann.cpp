#include "filtering/reference/sampling.h"

namespace domelight {

Vec3d riemann_sum(const ReferenceSource& source, const ZonalKernel& kernel, const Vec3d& axis,
                  const RiemannOptions& options) {
    const int K = options.phi_steps, J = options.theta_steps;
    const ReferenceFrame frame(axis);
    const KernelDensity density(kernel);
    Vec3d sum;
    double weights = 0;
    for (int j = 0; j < J; ++j) {
        const double theta = (j + 0.5) * (k_pi / 2) / J, half = std::sin(theta / 2);
        const double cosine = std::cos(theta), sine = std::sin(theta), weight = density(2 * half * half, cosine) * sine;
        for (int k = 0; k < K; ++k)
            sum += source.lookup(frame.direction(cosine, sine, (k + 0.5) * 2 * k_pi / K)) * weight;
        weights += weight * K;
    }
    if (!options.normalised) return sum * ((2 * k_pi / K) * (k_pi / 2 / J));
    // With a very narrow lobe, the weights of all rings may have underflowed.
    return weights > 0 ? sum / weights : source.lookup(axis);
}

}  // namespace domelight
