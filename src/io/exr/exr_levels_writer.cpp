// Writes OpenEXR images with levels.
#include "domelight/base/parallel.h"

#include "io/exr/exr_levels.h"
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
    if (const auto fit = check_exr_level_sizes(levels, cube); !fit) return fit.error().at(file.string());
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
                image = exr_level(levels[std::size_t(l)], cube);
            else
                image = next_exr_level(image);
            write_level(out, l, image, half);
        }
        return {};
    });
}

}  // namespace domelight
