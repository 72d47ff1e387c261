#include "compare/audit_orientation.h"

#include "domelight/base/parallel.h"

#include <fmt/format.h>

#include <algorithm>

namespace domelight {

OrientationSearch::OrientationSearch(TexelSample sample)
    : sample_(std::move(sample)), errors_(cube_orientations().size(), 2) {
    for (const Mat3& m : cube_orientations()) turned_.push_back(turned_texels(sample_, m));
}

void OrientationSearch::add(const Cubemap& exact, int threads) {
    parallel_for(int(errors_.size()), threads, [&](int o) {
        double& error = errors_[std::size_t(o)];
        const Fit fit = fit_level(sample_, values_at(exact, turned_[std::size_t(o)]), 0, true);
        error = std::min(error, fit.error);
    });
}

CubeOrientation OrientationSearch::found() const {
    const auto best = std::min_element(errors_.begin(), errors_.end());
    std::size_t chosen = std::size_t(best - errors_.begin());
    // If the light is symmetric and several orientations fit alike, "as ours" is the likeliest.
    if (errors_[0] <= 1.02 * *best + 1e-4) chosen = 0;
    CubeOrientation found;
    found.ours_from_theirs = cube_orientations()[chosen];
    found.words = orientation_words(found.ours_from_theirs);
    found.error = errors_[chosen];
    found.next_error = 2;
    for (std::size_t o = 0; o < errors_.size(); ++o)
        if (o != chosen) found.next_error = std::min(found.next_error, errors_[o]);
    found.certain = found.next_error > 1.25 * found.error + 1e-3;
    return found;
}

std::string orientation_words(const Mat3& m) {
    const Mat3 identity, mirror_x{{Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}};
    if (m == identity) return "as ours";
    const auto axis_mirrored = [&](int axis) {
        Mat3 mirror;
        mirror.row[std::size_t(axis)] = -mirror.row[std::size_t(axis)];
        return m == mirror;
    };
    if (axis_mirrored(0)) return "mirrored in x";
    if (axis_mirrored(1)) return "mirrored in y (upside down)";
    if (axis_mirrored(2)) return "mirrored in z";
    const double determinant = dot(m.row[0], cross(m.row[1], m.row[2]));
    // theirs(d) = ours(M d); light that was turned by R about +Y has M = R^T, mirrored in x before that: M = mirror
    // R^T.
    if (m.row[1] == Vec3d{0, 1, 0}) {
        const Mat3 turn = (determinant > 0 ? m : mirror_x * m).transposed();
        for (const int angle : {90, 180, 270}) {
            const double c = angle == 180 ? -1 : 0, s = angle == 90 ? 1 : angle == 270 ? -1 : 0;
            if (turn == Mat3{{Vec3d{c, 0, -s}, Vec3d{0, 1, 0}, Vec3d{s, 0, c}}})
                return fmt::format("{}turned by {} degrees about +Y", determinant > 0 ? "" : "mirrored in x, then ",
                                   angle);
        }
    }
    std::string text = determinant > 0 ? "turned:" : "mirrored and turned:";
    const char* names[3] = {"X", "Y", "Z"};
    for (int column = 0; column < 3; ++column) {
        const Vec3d d{m.row[0].x * (column == 0) + m.row[0].y * (column == 1) + m.row[0].z * (column == 2),
                      m.row[1].x * (column == 0) + m.row[1].y * (column == 1) + m.row[1].z * (column == 2),
                      m.row[2].x * (column == 0) + m.row[2].y * (column == 1) + m.row[2].z * (column == 2)};
        const int axis = d.x != 0 ? 0 : d.y != 0 ? 1 : 2;
        text += fmt::format("{} its +{} shows our {}{}", column ? "," : "", names[column],
                            d.x + d.y + d.z > 0 ? "+" : "-", names[axis]);
    }
    return text;
}

}  // namespace domelight
