#pragma once

#include "domelight/image.h"
#include "domelight/target.h"

#include <algorithm>
#include <utility>

namespace domelight {

/// Moves texels so that texture(cube, M d) gives what texture(cube, d) gave, M negating the axis. Its own inverse.
///
/// From OpenGL's face directions (projection.h): negating x swaps +X with -X and turns s to -s on every face; negating
/// z swaps +Z with -Z and turns s to -s on the four side faces, but t to -t on +Y and -Y.
inline void mirror_cube(Cubemap& cube, CubeMirror mirror) {
    if (mirror == CubeMirror::none) return;
    const int n = cube.size(), channels = cube.channels();
    const auto flip_s = [&](int f) {
        for (int y = 0; y < n; ++y) {
            float* row = cube.face(f).row(y);
            for (int x = 0; x < n / 2; ++x)
                std::swap_ranges(row + x * channels, row + (x + 1) * channels, row + (n - 1 - x) * channels);
        }
    };
    const auto swap_rows = [&](int f, int y, int g, int z) {
        float* row = cube.face(f).row(y);
        std::swap_ranges(row, row + n * channels, cube.face(g).row(z));
    };
    const int first = mirror == CubeMirror::x ? 0 : 4;
    for (int y = 0; y < n; ++y) swap_rows(first, y, first + 1, y);
    for (int f = 0; f < 6; ++f) {
        if (mirror == CubeMirror::z && (f == 2 || f == 3)) {
            for (int y = 0; y < n / 2; ++y) swap_rows(f, y, f, n - 1 - y);
        } else {
            flip_s(f);
        }
    }
}

}  // namespace domelight
