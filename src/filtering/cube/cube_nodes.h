#pragma once

#include <vector>

namespace domelight {

/// Nodes of a quadrature along one coordinate of a cube's face, cut at texel centres and at the face's edges. Coordinates run
/// over [-1, 1].
struct AxisNode {
    double at, weight;
    int cell;         ///< between texels cell and cell + 1; -1 .. size - 1
    double fraction;  ///< from texel `cell` to the next
};

std::vector<AxisNode> axis_nodes(int size, int nodes_a_cell);

}  // namespace domelight
