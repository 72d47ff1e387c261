#include "projection/bilinear.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// Between four texels: `s` to the right, from a to b and from c to d; `t` down, from the upper pair to the lower.
Vec3f mix(const float* a, const float* b, const float* c, const float* d, float s, float t) {
    const auto channel = [&](int k) {
        const float upper = a[k] + s * (b[k] - a[k]), lower = c[k] + s * (d[k] - c[k]);
        return upper + t * (lower - upper);
    };
    return {channel(0), channel(1), channel(2)};
}

}  // namespace

Vec3f bilinear(ImageView<const float> image, UV uv, bool wrap) {
    const int width = image.width, height = image.height;
    const double x = uv.u * width - 0.5, y = std::clamp(uv.v * height - 0.5, 0.0, double(height - 1));
    const auto column = [&](int i) { return wrap ? (i + width) % width : std::clamp(i, 0, width - 1); };
    const int i = int(std::floor(x)), j = int(y), below = std::min(j + 1, height - 1);
    const float s = float(x - i), t = float(y - j);
    const float *a = image.at(column(i), j), *b = image.at(column(i + 1), j), *c = image.at(column(i), below),
                *d = image.at(column(i + 1), below);
    return mix(a, b, c, d, s, t);
}

CubeTap cube_tap(int size, const Vec3f& direction) {
    const CubePoint p = cube_point(Vec3d(direction));
    const float x = float(p.uv.u * size) - 0.5f, y = float(p.uv.v * size) - 0.5f;
    const int i = std::clamp(int(std::floor(x)), -1, size - 1), j = std::clamp(int(std::floor(y)), -1, size - 1);
    return {p.face, i, j, x - float(i), y - float(j)};
}

Vec3f look_up(const BorderedCube& cube, const Vec3f& direction) {
    const CubeTap p = cube_tap(cube.size(), direction);
    const auto texel = [&](int right, int down) { return cube.texel(p.face, p.column + right, p.row + down); };
    return mix(texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1), p.s, p.t);
}

}  // namespace domelight
