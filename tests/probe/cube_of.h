#pragma once

#include "domelight/image/image.h"
#include "domelight/projection/projection.h"

#include <functional>

namespace domelight::test {

/// A cube whose texels have the value of their centre's direction.
inline Cubemap cube_of(int size, int channels, const std::function<void(const Vec3d& direction, float* texel)>& value) {
    Cubemap cube(size, channels);
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x)
                value(normalize(cube_direction(f, {(x + 0.5) / size, (y + 0.5) / size})), cube.face(f).at(x, y));
    return cube;
}

}  // namespace domelight::test
