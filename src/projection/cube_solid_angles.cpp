#include "projection/cube_solid_angles.h"

#include "domelight/base/parallel.h"

#include <cmath>

namespace domelight {

std::vector<double> cube_solid_angles(int size, int threads) {
    const std::size_t n = std::size_t(size), corners = n + 1;
    // The solid angle between the face's centre and each corner (s, t).
    std::vector<double> corner(corners * corners), angles(n * n);
    parallel_for(size + 1, threads, [&](int y) {
        for (int x = 0; x <= size; ++x) {
            const double s = 2.0 * x / size - 1, t = 2.0 * y / size - 1;
            corner[std::size_t(y) * corners + std::size_t(x)] = std::atan2(s * t, std::sqrt(s * s + t * t + 1));
        }
    });
    for (std::size_t y = 0; y < n; ++y) {
        const double *above = &corner[y * corners], *below = above + corners;
        for (std::size_t x = 0; x < n; ++x) angles[y * n + x] = (below[x + 1] - below[x]) - (above[x + 1] - above[x]);
    }
    return angles;
}

}  // namespace domelight
