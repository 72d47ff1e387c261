#pragma once

#include "filtering/harmonic/bright_texels.h"

namespace domelight {

/// Adds a lat-long texel's tent, its part of the bilinear reconstruction, as the nodes of Gauss-Legendre rules: its
/// four patches, nodes x nodes each. Where the texel's row touches a pole the tent is constant beyond the row's centre.
void add_tent_nodes(BrightPoints& points, int width, int height, int x, int y, const float* rgb, int nodes);

}  // namespace domelight
