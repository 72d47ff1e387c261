#pragma once

#include "domelight/sampling/low_discrepancy.h"
#include "domelight/filtering/reference.h"

#include "filtering/kernel/kernel_density.h"
#include "filtering/reference/source.h"

namespace domelight {

/// An orthonormal frame about `axis` (unit length).
struct ReferenceFrame {
    Vec3d tangent, bitangent, axis;
    explicit ReferenceFrame(const Vec3d& n) : axis(n) {
        const Vec3d away = std::abs(n.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
        tangent = normalize(cross(away, n));
        bitangent = cross(n, tangent);
    }
    /// Direction at polar angle with this cosine and sine from the axis.
    Vec3d direction(double cosine, double sine, double azimuth) const {
        return tangent * (sine * std::cos(azimuth)) + bitangent * (sine * std::sin(azimuth)) + axis * cosine;
    }
};

/// The textbook Riemann sum over the hemisphere about `axis`, K polar by J azimuth steps at their midpoints,
///   sum_kj K(cos theta_k) g(theta_k, phi_j) sin theta_k / sum_kj K(cos theta_k) sin theta_k,
/// theta_k = (k + 1/2) pi / 2K, phi_j = (j + 1/2) 2 pi / J. For the clamped cosine the courses' irradiance loop, pi /
/// (K J) times the sum of g cos theta sin theta, is this but for a factor 1 + O(K^-2): here the weights are made to sum
/// to 1, so that a constant stays constant.
Vec3d riemann_sum(const ReferenceSource& source, const ZonalKernel& kernel, const Vec3d& axis, int polar, int azimuth);

/// The courses' Monte Carlo prefilter (Karis 2013, PrefilterEnvMap): n = v = r = axis, Hammersley points, half vectors
/// drawn from the lobe (ggx: D n.h; charlie: D n.h, as the Khronos tools draw it; phong: the light direction itself
/// from cos^n), each sample of the light weighted by n.l and the sum divided by the weights.
Vec3d montecarlo_sum(const ReferenceSource& source, const ZonalKernel& kernel, const Vec3d& axis, int samples);

}  // namespace domelight
