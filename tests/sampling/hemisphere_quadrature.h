#pragma once
// Integrals over patches of the upper hemisphere, for densities and BRDFs with arbitrarily narrow peaks.

#include "domelight/base/vec.h"

#include "base/gauss_legendre.h"

#include <array>
#include <cmath>

namespace domelight::test {

/// theta0..theta1 by phi0..phi1, polar angle from +Z and azimuth.
struct Patch {
    double theta0, theta1, phi0, phi1;
};

inline Vec3d hemisphere_direction(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// ∫ g(direction) dω over the patch by 8 x 8 Gauss-Legendre nodes.
template <typename G>
double integrate_once(const Patch& p, const G& g) {
    const GaussLegendre& rule = gauss_legendre(8);
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const double theta = p.theta0 + (p.theta1 - p.theta0) * (1 + rule.x[i]) / 2;
        for (int j = 0; j < 8; ++j) {
            const double phi = p.phi0 + (p.phi1 - p.phi0) * (1 + rule.x[j]) / 2;
            sum += rule.w[i] * rule.w[j] * std::sin(theta) * g(hemisphere_direction(theta, phi));
        }
    }
    return sum * (p.theta1 - p.theta0) * (p.phi1 - p.phi0) / 4;
}

/// The same, halving the patch until this changes the result by less than `tolerance`.
template <typename G>
double integrate(const Patch& p, const G& g, double tolerance, int depth = 0) {
    const double theta = (p.theta0 + p.theta1) / 2, phi = (p.phi0 + p.phi1) / 2;
    const std::array<Patch, 4> quarters{{{p.theta0, theta, p.phi0, phi},
                                         {theta, p.theta1, p.phi0, phi},
                                         {p.theta0, theta, phi, p.phi1},
                                         {theta, p.theta1, phi, p.phi1}}};
    double fine = 0;
    for (const Patch& quarter : quarters) fine += integrate_once(quarter, g);
    if (depth >= 8 || std::abs(fine - integrate_once(p, g)) < tolerance) return fine;
    double sum = 0;
    for (const Patch& quarter : quarters) sum += integrate(quarter, g, tolerance / 2, depth + 1);
    return sum;
}

/// Patch i of the hemisphere cut into `polar` by `azimuth` of them, equal in angle.
inline Patch hemisphere_patch(int i, int polar, int azimuth) {
    const int row = i / azimuth, column = i % azimuth;
    return {k_pi / 2 * row / polar, k_pi / 2 * (row + 1) / polar, 2 * k_pi * column / azimuth,
            2 * k_pi * (column + 1) / azimuth};
}
/// The patch that contains a direction with z > 0.
inline int hemisphere_patch_of(const Vec3d& d, int polar, int azimuth) {
    const double theta = std::atan2(std::hypot(d.x, d.y), d.z);
    double phi = std::atan2(d.y, d.x);
    if (phi < 0) phi += 2 * k_pi;
    return std::min(int(theta / (k_pi / 2) * polar), polar - 1) * azimuth +
           std::min(int(phi / (2 * k_pi) * azimuth), azimuth - 1);
}

}  // namespace domelight::test
