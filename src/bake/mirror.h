#pragma once

#include "domelight/engines/engine.h"

#include "image/mirror_cube.h"

#include <algorithm>

namespace domelight {

/// Moves texels so that texture(cube, M d) gives what texture(cube, d) gave, where M is the mirroring of an engine's
/// lookup. Its own inverse.
inline void mirror_cube(Cubemap& cube, CubeMirror mirror) {
    if (cube.empty()) return;
    switch (mirror) {
        case CubeMirror::none:
            return;
        case CubeMirror::x:
            return mirror_cube_x(cube);
        case CubeMirror::z:
            return mirror_cube_z(cube);
        case CubeMirror::swap_yz:
            return swap_cube_yz(cube);
    }
}

/// Moves the columns of a lat-long map in the default convention by quarter turns: to a convention whose centre lies
/// that many quarter turns further to the right. -n undoes n. The width is a multiple of 4, or `quarters` is even and
/// the width too.
inline void turn_latlong(ImageF& map, int quarters) {
    if (map.empty()) return;
    const int columns = map.width() * ((quarters % 4 + 4) % 4) / 4;
    const std::ptrdiff_t row_values = std::ptrdiff_t(map.width()) * map.channels(),
                         shift = std::ptrdiff_t(columns) * map.channels();
    for (int y = 0; y < map.height(); ++y) std::rotate(map.row(y), map.row(y) + shift, map.row(y) + row_values);
}

}  // namespace domelight
