#include "projection/bordered_cube.h"

#include "domelight/projection/projection.h"

#include <algorithm>

namespace domelight {

int texel_or_across(int size, int face, int x, int y) {
    // A point a thousandth of a step outside the edge already belongs to the neighbour.
    const auto coordinate = [&](int i) { return std::clamp((i + 0.5) / size, -1e-3 / size, 1 + 1e-3 / size); };
    const auto outside = [&](int i) { return i < 0 || i == size; };
    if (!outside(x) && !outside(y)) return (face * size + y) * size + x;
    const CubePoint p = cube_point(cube_direction(face, {coordinate(x), coordinate(y)}));
    const auto index = [&](double u) { return std::clamp(int(u * size), 0, size - 1); };
    return (p.face * size + index(p.uv.v)) * size + index(p.uv.u);
}

BorderedCube::BorderedCube(const Cubemap& source)
    : size_(source.size()), texels_(std::size_t(18) * (size_ + 2) * (size_ + 2)) {
    const int n = size_;
    const float* texels = source.pixels().data();
    for (int f = 0; f < 6; ++f) {
        for (int y = -1; y <= n; ++y)
            for (int x = -1; x <= n; ++x) {
                const bool outside_x = x < 0 || x == n, outside_y = y < 0 || y == n;
                if (outside_x && outside_y) continue;
                std::copy_n(texels + 3 * std::ptrdiff_t(texel_or_across(n, f, x, y)), 3, texel(f, x, y));
            }
        for (const int y : {-1, n})
            for (const int x : {-1, n}) {
                const int inside_x = std::clamp(x, 0, n - 1), inside_y = std::clamp(y, 0, n - 1);
                for (int c = 0; c < 3; ++c)
                    texel(f, x, y)[c] =
                        (texel(f, inside_x, inside_y)[c] + texel(f, x, inside_y)[c] + texel(f, inside_x, y)[c]) *
                        (1.f / 3);
            }
    }
}

}  // namespace domelight
