#pragma once
// An environment whose radiance states its direction: 2 + (x, y, z).

#include "domelight/environment/environment.h"
#include "domelight/image/repair_report.h"
#include "domelight/image/row_source.h"
#include "domelight/projection/projection.h"

#include <algorithm>
#include <memory>

namespace domelight::test {

inline ImageF direction_image(int height) {
    ImageF image(2 * height, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x) {
            const Vec3d d = latlong_direction({(x + 0.5) / (2 * height), (y + 0.5) / height});
            float* p = image.at(x, y);
            p[0] = float(2 + d.x), p[1] = float(2 + d.y), p[2] = float(2 + d.z);
        }
    return image;
}

inline Environment environment_of(const ImageF& image) {
    Environment environment = Environment::from_latlong(image);
    environment.format = "test";
    return environment;
}

/// The direction that a texel's radiance states, not normalised.
inline Vec3d direction_of(const float* texel) {
    return {texel[0] - 2.0, texel[1] - 2.0, texel[2] - 2.0};
}

/// The texel at a point of a picture.
inline const float* texel_at(const ImageF& image, double u, double v) {
    return image.at(std::clamp(int(u * image.width()), 0, image.width() - 1),
                    std::clamp(int(v * image.height()), 0, image.height() - 1));
}

/// The largest distance between what a cube shows in a direction and that direction, over all its texels. `seen(d)`:
/// the direction whose light a lookup of d should give.
template <typename Seen>
double worst_direction(const Cubemap& cube, Seen seen) {
    double worst = 0;
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < cube.size(); ++y)
            for (int x = 0; x < cube.size(); ++x) {
                const Vec3d d = normalize(cube_direction(f, {(x + 0.5) / cube.size(), (y + 0.5) / cube.size()}));
                worst = std::max(worst, length(direction_of(cube.face(f).at(x, y)) - seen(d)));
            }
    return worst;
}

}  // namespace domelight::test
