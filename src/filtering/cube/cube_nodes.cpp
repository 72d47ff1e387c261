#include "filtering/cube/cube_nodes.h"

#include "base/gauss_legendre.h"

namespace domelight {

std::vector<AxisNode> axis_nodes(int size, int nodes_a_cell) {
    const auto& rule = gauss_legendre(nodes_a_cell);
    std::vector<AxisNode> nodes;
    for (int cell = -1; cell < size; ++cell) {
        const double low = cell < 0 ? 0.5 : 0, high = cell == size - 1 ? 0.5 : 1;
        for (std::size_t q = 0; q < rule.x.size(); ++q) {
            const double fraction = low + (high - low) * 0.5 * (1 + rule.x[q]);
            nodes.push_back({2 * (cell + 0.5 + fraction) / size - 1, rule.w[q] * (high - low) / size, cell, fraction});
        }
    }
    return nodes;
}

}  // namespace domelight
