#include "filtering/lights/tent_nodes.h"

#include "base/gauss_legendre.h"

#include <algorithm>
#include <cmath>

namespace domelight {

TentPatches::TentPatches(int width, int height, int nodes) : width_(width), height_(height), nodes_(nodes) {}

TentPatches::Patch& TentPatches::patch(int x, int y) {
    return patches_.try_emplace(std::int64_t(y) * width_ + (x + width_) % width_, Patch{nodes_, -1}).first->second;
}

void TentPatches::refine(int x, int y) {
    for (int row = y - 1; row <= y; ++row)
        for (int column = x - 1; column <= x; ++column) patch(column, row).nodes = 2 * nodes_;
}

const TentPatches::Patch& TentPatches::lit_patch(int x, int y) {
    Patch& p = patch(x, y);
    if (p.first >= 0) return p;
    p.first = lights_.count();
    const double step_theta = k_pi / height_, step_phi = 2 * k_pi / width_;
    const double top = std::max(step_theta * (y + 0.5), 0.0), bottom = std::min(step_theta * (y + 1.5), k_pi);
    const auto& rule = gauss_legendre(p.nodes);
    const float black[3] = {};
    for (int i = 0; i < p.nodes; ++i)
        for (int j = 0; j < p.nodes; ++j) {
            const double theta = top + 0.5 * (1 + rule.x[i]) * (bottom - top),
                         phi = step_phi * (x + 0.5 + 0.5 * (1 + rule.x[j])) - k_pi;
            lights_.add({std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)}, 0, black);
        }
    return p;
}

void TentPatches::add(int x, int y, const float* rgb) {
    const double step_theta = k_pi / height_, step_phi = 2 * k_pi / width_;
    for (int down = 0; down <= 1; ++down)
        for (int right = 0; right <= 1; ++right) {
            // The patch above the texel has it at its lower edge.
            const int row = y - 1 + down;
            const Patch& patch = lit_patch(x - 1 + right, row);
            const auto& rule = gauss_legendre(patch.nodes);
            const bool cap = row < 0 || row == height_ - 1;
            const double top = std::max(step_theta * (row + 0.5), 0.0), height = (cap ? 0.5 : 1.0) * step_theta;
            for (int i = 0; i < patch.nodes; ++i)
                for (int j = 0; j < patch.nodes; ++j) {
                    const double a = 0.5 * (1 + rule.x[i]), b = 0.5 * (1 + rule.x[j]);
                    const double weight = (cap    ? 1
                                           : down ? 1 - a
                                                  : a) *
                                          (right ? 1 - b : b) * std::sin(top + a * height) * 0.25 * rule.w[i] *
                                          rule.w[j] * height * step_phi;
                    lights_.brighten(patch.first + i * patch.nodes + j, weight, rgb);
                }
        }
}

void add_tent_nodes(PointLights& points, int width, int height, int x, int y, const float* rgb, int nodes) {
    TentPatches patches(width, height, nodes);
    patches.add(x, y, rgb);
    points.append(patches.lights(), 0, patches.lights().count());
}

}  // namespace domelight
