#include "projection/bordered_cube.h"

#include "domelight/projection/projection.h"

#include <algorithm>

namespace domelight {

BorderedCube::BorderedCube(const Cubemap& source)
    : size_(source.size()), texels_(std::size_t(18) * (size_ + 2) * (size_ + 2)) {
    const int n = size_;
    // The texel across the edge from texel (x, y), which lies one step outside: a point a thousandth of a step outside
    // the edge already belongs to the neighbour.
    const auto across = [&](int f, int x, int y) {
        const auto coordinate = [&](int i) { return std::clamp((i + 0.5) / n, -1e-3 / n, 1 + 1e-3 / n); };
        const CubePoint p = cube_point(cube_direction(f, {coordinate(x), coordinate(y)}));
        const auto index = [&](double u) { return std::clamp(int(u * n), 0, n - 1); };
        return source.face(p.face).at(index(p.uv.u), index(p.uv.v));
    };
    for (int f = 0; f < 6; ++f) {
        for (int y = -1; y <= n; ++y)
            for (int x = -1; x <= n; ++x) {
                const bool outside_x = x < 0 || x == n, outside_y = y < 0 || y == n;
                if (outside_x && outside_y) continue;
                std::copy_n(outside_x || outside_y ? across(f, x, y) : source.face(f).at(x, y), 3, texel(f, x, y));
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
