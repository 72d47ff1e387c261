#pragma once

#include "domelight/filtering/reference.h"
#include "domelight/sampling/low_discrepancy.h"

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

/// The Riemann sum over the hemisphere about `axis`, at the midpoints of K steps of phi and J of theta,
///   sum_kj w_j g(theta_j, phi_k),   w_j = D(cos theta_j) sin theta_j (2 pi / K) (pi / 2J),
/// phi_k = (k + 1/2) 2 pi / K, theta_j = (j + 1/2) pi / 2J, with the lobe's density D. For the clamped cosine this is
/// the double sum for E / pi, pi / (K J) times the sum of g cos theta sin theta, whose weights sum to 1 + O(J^-2).
/// `normalised` divides by that sum, so that a constant stays constant.
Vec3d riemann_sum(const ReferenceSource& source, const ZonalKernel& kernel, const Vec3d& axis,
                  const RiemannOptions& options);

/// The Monte Carlo prefilter of Karis 2013 (PrefilterEnvMap): n = v = r = axis, half vectors drawn from the lobe
/// (ggx: D n.h; charlie: D n.h, as the Khronos tools draw it; phong: the light direction itself from cos^n), each
/// sample of the light weighted by n.l and the sum divided by the weights. A point's x gives phi, its y theta.
Vec3d montecarlo_sum(const ReferenceSource& source, const ZonalKernel& kernel, const Vec3d& axis,
                     const PointSet& points);

}  // namespace domelight
