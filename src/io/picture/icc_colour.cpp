#include "io/picture/icc_profile.h"

#include <algorithm>
#include <cmath>

namespace domelight {

bool is_srgb(const ScreenColour& colour, int levels) {
    if (colour.to_rec709) return false;
    const std::vector<float> srgb = screen_curve(Decode::srgb, levels);
    for (const auto& curve : colour.curves)
        for (std::size_t i = 0; i < curve.size(); ++i)
            if (std::abs(curve[i] - srgb[i]) > 1e-3f) return false;
    return true;
}

std::optional<Mat3> rec709_of_colourants(const Mat3& columns) {
    constexpr double d50[3] = {0.9642, 1, 0.8249};
    constexpr double sum = d50[0] + d50[1] + d50[2];
    const Mat3 matrix = *xyz_to_rec709(ColourPrimaries::Xy{d50[0] / sum, d50[1] / sum}) * columns;
    // Colourants are rounded to 1 / 65536, and sRGB's in several ways.
    const Mat3 identity;
    double change = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d d = matrix.row[i] - identity.row[i];
        change = std::max({change, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    }
    if (change > 2e-3) return matrix;
    return std::nullopt;
}

}  // namespace domelight
