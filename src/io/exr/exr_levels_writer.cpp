// Writes OpenEXR images with levels.
#include "domelight/base/parallel.h"

#include "io/exr/exr_stream.h"
#include "io/exr/exr_writing.h"
#include "texture/texel/half.h"

#include <ImfFrameBuffer.h>
#include <ImfTiledOutputFile.h>

#include <algorithm>

namespace domelight {

namespace {

/// OpenEXR's own choice for its tools.
constexpr unsigned k_tile = 64;

Error wrong_size(std::size_t level, ImageView<const float> image) {
    return {"level " + std::to_string(level) + " is " + std::to_string(image.width) + " x " +
                std::to_string(image.height) + ", not half the one before",
            "", "Each level of an OpenEXR image is half as wide and high, rounded down."};
}

Result<void> check_sizes(std::span<const ImageView<const float>> levels, bool cube) {
    for (std::size_t l = 1; l < levels.size(); ++l) {
        const int width = std::max(1, levels[0].width >> l), height = std::max(1, levels[0].height >> l);
        const bool strip = !cube || (levels[l].height == 6 * levels[l].width);
        if (levels[l].width != width || levels[l].height != height || !strip ||
            levels[l].channels != levels[0].channels)
            return wrong_size(l, levels[l]);
    }
    return {};
}

/// The next level of an image, by averaging two by two texels; an odd last row or column is averaged with the one
/// before.
ImageF half_of(const ImageF& image) {
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

ImageF copy_of(ImageView<const float> view) {
    ImageF image(view.width, view.height, view.channels);
    for (int y = 0; y < view.height; ++y) std::copy_n(view.row(y), view.width * view.channels, image.row(y));
    return image;
}

/// May throw.
void write_level(Imf::TiledOutputFile& file, int level, const ImageF& image, bool half) {
    std::vector<std::uint16_t> halves;
    if (half)
        for (const float v : image.pixels()) halves.push_back(half_from_float(std::clamp(v, -k_half_max, k_half_max)));
    const std::size_t channel_bytes = half ? 2 : 4, pixel = channel_bytes * std::size_t(image.channels()),
                      line = pixel * std::size_t(image.width());
    // OpenEXR does not write to the pixels.
    char* base = half ? reinterpret_cast<char*>(halves.data())
                      : reinterpret_cast<char*>(const_cast<float*>(image.pixels().data()));
    Imf::FrameBuffer frame;
    const auto names = exr_channel_names(image.channels());
    for (std::size_t c = 0; c < names.size(); ++c)
        frame.insert(names[c], Imf::Slice(half ? Imf::HALF : Imf::FLOAT, base + channel_bytes * c, pixel, line));
    file.setFrameBuffer(frame);
    file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
}

}  // namespace

Result<void> write_exr_levels(const std::filesystem::path& file, std::span<const ImageView<const float>> levels,
                              const ExrWriteOptions& options) {
    if (levels.empty()) return Error{"no level to write", file.string(), ""};
    const bool cube = options.envmap == "cube";
    const bool half =
        options.half ? *options.half
                     : std::all_of(levels.begin(), levels.end(), [](const auto& level) { return fits_half(level); });
    if (const auto fit = check_sizes(levels, cube); !fit) return fit.error().at(file.string());
    return write_exr_file(file, [&](ExrOutputStream& stream) -> Result<void> {
        auto header = exr_header(levels[0].width, levels[0].height, levels[0].channels, half, options);
        if (!header) return header.error();
        header->setTileDescription(Imf::TileDescription(k_tile, k_tile, Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN));
        const int threads = resolve_threads(options.threads);
        provide_exr_threads(threads);
        Imf::TiledOutputFile out(stream, *header, threads > 1 ? threads : 0);
        ImageF image;
        for (int l = 0; l < out.numLevels(); ++l) {
            if (std::size_t(l) < levels.size())
                image = cube ? exr_cube_strip(levels[std::size_t(l)]) : copy_of(levels[std::size_t(l)]);
            else
                image = half_of(image);
            write_level(out, l, image, half);
        }
        return {};
    });
}

}  // namespace domelight
