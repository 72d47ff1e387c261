#pragma once

#include "filtering/resample/reproject_block.h"

#include <array>
#include <span>

namespace domelight::reproject_detail {

/// A smooth function of the position in a block of k_tile^2 texels, known at a grid of nodes: interpolated by a
/// polynomial of the fifth degree along each axis. Along a block's border it depends on the nodes there alone, so that
/// neighbours agree about it.
class NodeGrid {
  public:
    static constexpr int k_nodes = 6;
    static constexpr int k_tests = 5;
    /// The node's distance from the block's first corner, in texels: the extrema of a Chebyshev polynomial.
    static double node(int k);
    /// Positions between the nodes, where the interpolation errs most.
    static SourcePoint test(int k);

    double& at(int i, int j) { return value_[std::size_t(j * k_nodes + i)]; }
    /// The interpolated function at test(k).
    double at_test(int k) const;
    /// The interpolated function at all corners, row by row.
    void at_corners(std::span<double> out) const;

  private:
    std::array<double, std::size_t(k_nodes) * k_nodes> value_{};
};

}  // namespace domelight::reproject_detail
