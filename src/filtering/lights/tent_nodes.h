#pragma once

#include "filtering/lights/point_lights.h"

#include <cstdint>
#include <unordered_map>

namespace domelight {

/// Adds a lat-long texel's tent, its part of the bilinear reconstruction, as the nodes of Gauss-Legendre rules: its
/// four patches, nodes x nodes each. Where the texel's row touches a pole the tent is constant beyond the row's centre.
void add_tent_nodes(PointLights& points, int width, int height, int x, int y, const float* rgb, int nodes);

/// The same for several texels, whose lights are shared where the tents overlap: each patch between texel centres has
/// nodes x nodes lights, and twice as many either way around the texels that are named first.
class TentPatches {
  public:
    TentPatches(int width, int height, int nodes);
    /// Before anything is added.
    void refine(int x, int y);
    void add(int x, int y, const float* rgb);
    const PointLights& lights() const { return lights_; }

  private:
    /// Nodes to the right of column x and below row y (-1: the cap above row 0).
    struct Patch {
        int nodes = 0;
        int first = -1;  ///< light; -1: not yet among the lights
    };
    Patch& patch(int x, int y);
    const Patch& lit_patch(int x, int y);

    int width_, height_, nodes_;
    std::unordered_map<std::int64_t, Patch> patches_;  ///< by y * width + x
    PointLights lights_;
};

}  // namespace domelight
