#include "domelight/sampling/microfacet.h"

#include "filtering/reference/sampling.h"

namespace domelight {
namespace {

/// A light direction by its cosine and sine from the axis.
struct Drawn {
    double cosine, sine;
};

/// The mirror image of the axis about a half vector with this sine: cos 2 theta_h, sin 2 theta_h.
Drawn reflect_about(double sin2_half) {
    return {1 - 2 * sin2_half, 2 * std::sqrt(sin2_half * (1 - sin2_half))};
}

Drawn draw(const KernelDensity& density, const ZonalKernel& kernel, double xi) {
    switch (kernel.lobe) {
        case Lobe::ggx: {
            // Karis 2013, ImportanceSampleGGX
            const double a2 = std::max(kernel.width, k_least_alpha) * std::max(kernel.width, k_least_alpha);
            return reflect_about(ggx_half_angle(xi, a2).sin2);
        }
        case Lobe::charlie: {
            // Khronos glTF-IBL-Sampler: sin theta_h = xi^(alpha / (2 alpha + 1)); with p = 1 / (2 alpha) the square of
            // that is xi^(1 / (1 + p)).
            return reflect_about(std::pow(xi, 1 / (1 + density.power())));
        }
        default: {
            const double cosine = std::pow(1 - xi, 1 / (kernel.width + 1));
            return {cosine, std::sqrt(std::max(0.0, 1 - cosine * cosine))};
        }
    }
}

}  // namespace

Vec3d montecarlo_sum(const ReferenceSource& source, const ZonalKernel& kernel, const Vec3d& axis,
                     const PointSet& points) {
    const ReferenceFrame frame(axis);
    const KernelDensity density(kernel);
    Vec3d sum;
    double weights = 0;
    for (int i = 0; i < points.count; ++i) {
        const UnitPoint point = points[i];
        const Drawn l = draw(density, kernel, unit_double(point.y));
        if (l.cosine <= 0) continue;
        const double weight = kernel.lobe == Lobe::phong_plain ? 1 : l.cosine;  // NdotL
        sum += source.lookup(frame.direction(l.cosine, l.sine, 2 * k_pi * unit_double(point.x))) * weight;
        weights += weight;
    }
    // No sample is above the horizon (charlie with very few samples): the lobe is replaced by its axis.
    return weights > 0 ? sum / weights : source.lookup(axis);
}

}  // namespace domelight
