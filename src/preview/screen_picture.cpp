#include "preview/screen_picture.h"

#include "domelight/base/parallel.h"

#include "preview/exposure_meter.h"

#include <algorithm>

namespace domelight {

double automatic_ev(ImageView<const float> rgb, ImageView<const float> weights, bool premultiplied) {
    ExposureMeter meter;
    meter.add(rgb, weights, premultiplied);
    return meter.ev();
}

Image<std::uint8_t> screen_picture(ImageView<const float> rgb, ImageView<const float> opacity, const Display& display,
                                   int threads) {
    const bool transparent = opacity.width > 0;
    Image<std::uint8_t> pixels(rgb.width, rgb.height, transparent ? 4 : 3);
    parallel_for(rgb.height, threads, [&](int y) {
        for (int x = 0; x < rgb.width; ++x) {
            const float* p = rgb.at(x, y);
            Vec3f c{p[0], p[1], p[2]};
            std::uint8_t* q = pixels.at(x, y);
            if (transparent) {
                const float covered = std::clamp(*opacity.at(x, y), 0.0f, 1.0f);
                if (covered > 0) c = c / covered;
                q[3] = to_byte(covered);
            }
            const auto shown = display.rgb8(c);
            std::copy(shown.begin(), shown.end(), q);
        }
    });
    return pixels;
}

}  // namespace domelight
