#include "filtering/reference/sampling.h"

namespace domelight {

Vec3d riemann_sum(const ReferenceSource& source, const ZonalKernel& kernel, const Vec3d& axis, int polar, int azimuth) {
    const ReferenceFrame frame(axis);
    const KernelDensity density(kernel);
    Vec3d sum;
    double weights = 0;
    for (int k = 0; k < polar; ++k) {
        const double theta = (k + 0.5) * (k_pi / 2) / polar, half = std::sin(theta / 2);
        const double cosine = std::cos(theta), sine = std::sin(theta), weight = density(2 * half * half, cosine) * sine;
        for (int j = 0; j < azimuth; ++j)
            sum = sum + source.lookup(frame.direction(cosine, sine, (j + 0.5) * 2 * k_pi / azimuth)) * weight;
        weights += weight * azimuth;
    }
    // Every ring of a very narrow lobe may have underflowed.
    return weights > 0 ? sum / weights : source.lookup(axis);
}

}  // namespace domelight
