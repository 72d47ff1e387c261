#include "io/exr/exr_levels.h"

#include "domelight/io/write_image.h"

#include "texture/texel/half.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace domelight {

namespace {

Error wrong_size(std::size_t level, ImageView<const float> image) {
    return {"level " + std::to_string(level) + " is " + std::to_string(image.width) + " x " +
                std::to_string(image.height) + ", not half the one before",
            "", "Each level of an OpenEXR image is half as wide and high, rounded down."};
}

}  // namespace

bool fits_half(ImageView<const float> pixels) {
    for (int y = 0; y < pixels.height; ++y)
        for (const float* v = pixels.row(y); v < pixels.row(y) + pixels.width * pixels.channels; ++v)
            if (std::abs(*v) > k_half_max) return false;
    return true;
}

// ImfEnvmap.h draws OpenEXR's: seen along its axis each face is the mirror image of OpenGL's, +X -X +Z -Z left to
// right, +Y -Y top to bottom.
ImageF exr_cube_strip(ImageView<const float> strip) {
    ImageF turned(strip.width, strip.height, strip.channels);
    const int size = strip.width, channels = strip.channels;
    for (int f = 0; f < 6; ++f) {
        const bool vertical = f == 2 || f == 3;
        for (int y = 0; y < size; ++y) {
            const float* from = strip.row(f * size + (vertical ? size - 1 - y : y));
            float* to = turned.row(f * size + y);
            if (vertical)
                std::copy_n(from, size * channels, to);
            else
                for (int x = 0; x < size; ++x)
                    std::copy_n(from + (size - 1 - x) * channels, channels, to + x * channels);
        }
    }
    return turned;
}

Result<void> check_exr_level_sizes(std::span<const ImageView<const float>> levels, bool cube) {
    for (std::size_t l = 1; l < levels.size(); ++l) {
        const int width = std::max(1, levels[0].width >> l), height = std::max(1, levels[0].height >> l);
        const bool strip = !cube || (levels[l].height == 6 * levels[l].width);
        if (levels[l].width != width || levels[l].height != height || !strip ||
            levels[l].channels != levels[0].channels)
            return wrong_size(l, levels[l]);
    }
    return {};
}

ImageF next_exr_level(const ImageF& image) {
    ImageF half(std::max(1, image.width() / 2), std::max(1, image.height() / 2), image.channels());
    const auto range = [](int i, int count, int from) {
        return std::pair{std::min(2 * i, from - 1), i == count - 1 ? from : 2 * i + 2};
    };
    for (int y = 0; y < half.height(); ++y)
        for (int x = 0; x < half.width(); ++x)
            for (int c = 0; c < half.channels(); ++c) {
                const auto [x0, x1] = range(x, half.width(), image.width());
                const auto [y0, y1] = range(y, half.height(), image.height());
                double sum = 0;
                for (int v = y0; v < y1; ++v)
                    for (int u = x0; u < x1; ++u) sum += double(image.at(u, v)[c]);
                half.at(x, y)[c] = float(sum / ((x1 - x0) * (y1 - y0)));
            }
    return half;
}

ImageF exr_level(ImageView<const float> level, bool cube) {
    if (cube) return exr_cube_strip(level);
    ImageF image(level.width, level.height, level.channels);
    for (int y = 0; y < level.height; ++y) std::copy_n(level.row(y), level.width * level.channels, image.row(y));
    return image;
}

}  // namespace domelight
