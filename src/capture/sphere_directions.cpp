#include "capture/sphere_directions.h"

#include <cmath>
#include <numbers>

namespace domelight {

std::vector<Vec3f> sphere_directions(int count) {
    std::vector<Vec3f> directions;
    directions.reserve(std::size_t(count));
    const double turn = 2 * k_pi / std::numbers::phi;
    for (int i = 0; i < count; ++i) {
        const double y = 1 - (2 * i + 1.0) / count, s = std::sqrt(1 - y * y), a = turn * i;
        directions.push_back(Vec3f(Vec3d{s * std::cos(a), y, s * std::sin(a)}));
    }
    return directions;
}

}  // namespace domelight
