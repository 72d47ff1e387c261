#include "batch/thumbnail.h"

#include "domelight/compare/picture_reader.h"
#include "domelight/image/cube_layout.h"

#include "preview/screen_picture.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// Averages whole blocks of pixels, which is enough for a thumbnail.
ImageF reduced(const ImageF& image, int most) {
    const int step = std::max(1, (std::max(image.width(), image.height()) + most - 1) / most);
    const int width = std::max(1, image.width() / step), height = std::max(1, image.height() / step);
    ImageF out(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            double sum[3] = {};
            int count = 0;
            for (int v = y * step; v < std::min((y + 1) * step, image.height()); ++v)
                for (int u = x * step; u < std::min((x + 1) * step, image.width()); ++u, ++count)
                    for (int c = 0; c < 3; ++c) sum[c] += image.at(u, v)[c];
            for (int c = 0; c < 3; ++c) out.at(x, y)[c] = float(sum[c] / count);
        }
    return out;
}

}  // namespace

Result<Image<std::uint8_t>> thumbnail(const std::filesystem::path& file, int width, int threads) {
    PictureOptions options;
    options.threads = threads;
    auto picture = read_picture(file, options);
    if (!picture) return picture.error();
    if (picture->cube) picture->rgb = cube_layout(Cubemap(std::move(picture->rgb)), "cross");
    for (float& v : picture->rgb.pixels()) v = std::isfinite(v) ? v : 0;
    const ImageF small = reduced(picture->rgb, width);
    const Display display = picture->high_dynamic_range
                                ? Display{Tonemap::agx, float(std::exp2(automatic_ev(small.view())))}
                                : Display{Tonemap::none, 1};
    return screen_picture(small.view(), {}, display, threads);
}

}  // namespace domelight
