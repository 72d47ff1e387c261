#include "domelight/capture/engine_files.h"

#include "capture/sphere_directions.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

constexpr int k_normals = 1024;  // at which the fit is made

/// The weights of the six values for a normal.
std::array<double, 6> weights(const Vec3d& n) {
    std::array<double, 6> w{};
    const double c[3] = {n.x, n.y, n.z};
    for (std::size_t axis = 0; axis < 3; ++axis) w[axis + (c[axis] < 0 ? 3 : 0)] = c[axis] * c[axis];
    return w;
}

using Matrix = std::array<std::array<double, 6>, 6>;

/// The inverse of a symmetric positive definite matrix, by Gauss and Jordan; no pivoting is needed.
Matrix inverse(Matrix a) {
    Matrix b{};
    for (std::size_t i = 0; i < 6; ++i) b[i][i] = 1;
    for (std::size_t i = 0; i < 6; ++i) {
        const double pivot = a[i][i];
        for (std::size_t j = 0; j < 6; ++j) a[i][j] /= pivot, b[i][j] /= pivot;
        for (std::size_t k = 0; k < 6; ++k) {
            const double f = a[k][i];
            if (k == i) continue;
            for (std::size_t j = 0; j < 6; ++j) a[k][j] -= f * a[i][j], b[k][j] -= f * b[i][j];
        }
    }
    return b;
}

/// The normals, and the inverse of the matrix of least squares Σ w wᵀ over them: the same for every probe.
struct Fit {
    std::vector<Vec3f> normals = sphere_directions(k_normals);
    Matrix inverse_gram;

    Fit() {
        Matrix gram{};
        for (const Vec3f& n : normals) {
            const auto w = weights(Vec3d(n));
            for (std::size_t i = 0; i < 6; ++i)
                for (std::size_t j = 0; j < 6; ++j) gram[i][j] += w[i] * w[j];
        }
        inverse_gram = inverse(gram);
    }
};

}  // namespace

Vec3f ambient_cube_at(const AmbientCube& cube, const Vec3f& normal) {
    const auto w = weights(Vec3d(normal));
    Vec3f sum;
    for (std::size_t i = 0; i < 6; ++i) sum += cube[i] * float(w[i]);
    return sum;
}

AmbientCube fit_ambient_cube(const ProbeSet& set, int probe) {
    static const Fit fit;
    std::array<Vec3d, 6> moments{};
    for (const Vec3f& n : fit.normals) {
        const auto w = weights(Vec3d(n));
        const Vec3d light(set.irradiance_over_pi(probe, n));
        for (std::size_t i = 0; i < 6; ++i) moments[i] += light * w[i];
    }
    AmbientCube cube{};
    for (std::size_t i = 0; i < 6; ++i) {
        Vec3d value;
        for (std::size_t j = 0; j < 6; ++j) value += moments[j] * fit.inverse_gram[i][j];
        cube[i] = {float(std::max(value.x, 0.0)), float(std::max(value.y, 0.0)), float(std::max(value.z, 0.0))};
    }
    return cube;
}

}  // namespace domelight
