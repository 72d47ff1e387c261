#include "image/mirror_cube.h"

#include <algorithm>
#include <utility>

namespace domelight {

namespace {

/// A face turns s to -s.
void flip_s(Cubemap& cube, int f) {
    const int n = cube.size(), channels = cube.channels();
    for (int y = 0; y < n; ++y) {
        float* row = cube.face(f).row(y);
        for (int x = 0; x < n / 2; ++x)
            std::swap_ranges(row + x * channels, row + (x + 1) * channels, row + (n - 1 - x) * channels);
    }
}

/// A face turns t to -t.
void flip_t(Cubemap& cube, int f) {
    const int n = cube.size();
    for (int y = 0; y < n / 2; ++y) {
        float* row = cube.face(f).row(y);
        std::swap_ranges(row, row + n * cube.channels(), cube.face(f).row(n - 1 - y));
    }
}

void swap_faces(Cubemap& cube, int f, int g) {
    const auto a = cube.face(f), b = cube.face(g);
    std::swap_ranges(a.data, a.data + std::size_t(cube.size()) * cube.size() * cube.channels(), b.data);
}

/// A face exchanges s and t: reflected in its diagonal.
void transpose(Cubemap& cube, int f) {
    const auto face = cube.face(f);
    for (int y = 0; y < cube.size(); ++y)
        for (int x = 0; x < y; ++x) std::swap_ranges(face.at(x, y), face.at(x, y) + cube.channels(), face.at(y, x));
}

}  // namespace

// What follows comes from OpenGL's face directions (projection.h, cube_direction).

void mirror_cube_x(Cubemap& cube) {
    swap_faces(cube, 0, 1);
    for (int f = 0; f < 6; ++f) flip_s(cube, f);
}

void mirror_cube_z(Cubemap& cube) {
    swap_faces(cube, 4, 5);
    for (const int f : {0, 1, 4, 5}) flip_s(cube, f);
    for (const int f : {2, 3}) flip_t(cube, f);
}

void swap_cube_yz(Cubemap& cube) {
    // +X is (1, -t, -s): y and z exchanged, (1, -s, -t). -X is (-1, -t, s): (-1, s, -t), so s' = -t, t' = -s.
    transpose(cube, 0);
    transpose(cube, 1);
    flip_s(cube, 1);
    flip_t(cube, 1);
    // +Y is (s, 1, t): (s, t, 1), on +Z at (s, -t). -Y is (s, -1, -t): (s, -t, -1), on -Z at (-s, t).
    swap_faces(cube, 2, 4);
    flip_t(cube, 2);
    flip_t(cube, 4);
    swap_faces(cube, 3, 5);
    flip_s(cube, 3);
    flip_s(cube, 5);
}

}  // namespace domelight
