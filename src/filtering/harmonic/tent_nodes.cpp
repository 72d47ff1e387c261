#include "filtering/harmonic/tent_nodes.h"

#include "base/gauss_legendre.h"

#include <cmath>

namespace domelight {

void add_tent_nodes(BrightPoints& points, int width, int height, int x, int y, const float* rgb, int nodes) {
    const double step_theta = k_pi / height, step_phi = 2 * k_pi / width;
    const auto& rule = gauss_legendre(nodes);
    for (int down = -1; down <= 1; down += 2)
        for (int right = -1; right <= 1; right += 2) {
            const bool cap = (down < 0 && y == 0) || (down > 0 && y == height - 1);
            const double length = (cap ? 0.5 : 1.0) * step_theta;
            for (int i = 0; i < nodes; ++i)
                for (int j = 0; j < nodes; ++j) {
                    const double a = 0.5 * (1 + rule.x[i]), b = 0.5 * (1 + rule.x[j]);
                    const double theta = step_theta * (y + 0.5) + down * a * length,
                                 phi = step_phi * (x + 0.5) - k_pi + right * b * step_phi;
                    const double weight = (cap ? 1 : 1 - a) * (1 - b) * std::sin(theta) * 0.25 * rule.w[i] * rule.w[j] *
                                          length * step_phi;
                    points.add({std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)},
                               weight, rgb);
                }
        }
}

}  // namespace domelight
