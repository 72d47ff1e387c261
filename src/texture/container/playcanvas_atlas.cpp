#include "texture/container/playcanvas_atlas.h"

#include "domelight/io/file/atomic_file.h"

#include "filtering/resample/resize_latlong.h"
#include "io/file/file_reader.h"
#include "io/file/output_file.h"
#include "io/picture/png_memory.h"
#include "io/picture/texture_image.h"
#include "texture/texel/rgba8_ranges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace domelight {

namespace {

/// The map of a rectangle, from a lat-long image. Its inner texels cover the whole sphere; its seam continues over the
/// edges: around the sphere at the sides, and past the poles (half a turn away) above and below.
ImageF with_seam(const ImageF& source, const AtlasRect& rect) {
    const int width = rect.width - 2, height = rect.height - 2;
    const ImageF inner = resize_latlong(source.view(), width, height);
    ImageF map(rect.width, rect.height, 3);
    for (int y = 0; y < rect.height; ++y) {
        const bool past_pole = y == 0 || y == rect.height - 1;
        const float* row = inner.row(std::clamp(y - 1, 0, height - 1));
        for (int x = 0; x < rect.width; ++x) {
            const int column = (x - 1 + width + (past_pole ? width / 2 : 0)) % width;
            std::copy_n(row + 3 * column, 3, map.at(x, y));
        }
    }
    return map;
}

/// Encodes a map into its place.
EncodingReport put(Image<std::uint8_t>& atlas, const AtlasRect& rect, const ImageF& source, int threads) {
    const FilteredMap map(Layout::latlong, with_seam(source, rect));
    std::vector<EncodingReport> reports;
    const Texture texture = encode_texture({&map, 1}, Encoding::rgbp, threads, &reports);
    const std::uint8_t* from = texture.levels[0].data();
    for (int y = 0; y < rect.height; ++y, from += 4 * rect.width)
        std::copy_n(from, 4 * rect.width, atlas.at(rect.x, rect.y + y));
    return reports.front();
}

ImageF decode_rect(ImageView<const std::uint8_t> atlas, const AtlasRect& rect) {
    ImageF map(rect.width - 2, rect.height - 2, 3);
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) {
            const std::uint8_t* p = atlas.at(rect.x + 1 + x, rect.y + 1 + y);
            const Vec3f v = rgb_from_rgbp({p[0], p[1], p[2], p[3]});
            float* out = map.at(x, y);
            out[0] = v.x, out[1] = v.y, out[2] = v.z;
        }
    return map;
}

}  // namespace

AtlasRect atlas_shiny_rect(int level) {
    // x = y = 512 (1 - 2^-level): the sum of the heights before.
    const int width = k_atlas_size >> level;
    return {k_atlas_size - width, k_atlas_size - width, width, width / 2};
}

AtlasRect atlas_rough_rect(int level) {
    const int width = k_atlas_size >> level;
    return {0, k_atlas_size - width, width, width / 2};
}

Image<std::uint8_t> make_playcanvas_atlas(std::span<const FilteredMap> maps, const FilteredMap& diffuse,
                                          const TexelOrder& order, int threads, std::vector<EncodingReport>* reports) {
    assert(maps.size() == 1 + k_atlas_rough_levels);
    Image<std::uint8_t> atlas(k_atlas_size, k_atlas_size, 4);
    std::vector<EncodingReport> all;
    {
        const FilteredMap environment = order.apply(maps[0]);
        for (int l = 0; l < k_atlas_shiny_levels; ++l) {
            const EncodingReport report = put(atlas, atlas_shiny_rect(l), environment.image, threads);
            if (l == 0) all.push_back(report);
        }
    }
    for (int l = 1; l <= k_atlas_rough_levels; ++l)
        all.push_back(put(atlas, atlas_rough_rect(l), order.apply(maps[std::size_t(l)]).image, threads));
    put(atlas, k_atlas_diffuse_rect, order.apply(diffuse).image, threads);
    if (reports) *reports = std::move(all);
    return atlas;
}

Result<void> write_playcanvas_atlas(const std::filesystem::path& file, const Image<std::uint8_t>& atlas) {
    const auto png = encode_png(atlas.view());
    if (!png) return png.error().at(file.string());
    return write_file_atomically(file, *png);
}

Result<PlayCanvasAtlas> playcanvas_atlas(std::span<const std::uint8_t> bytes) {
    const auto size = texture_image_size(bytes);
    if (!size) return size.error();
    if (size->width != k_atlas_size || size->height != k_atlas_size)
        return Error{fmt::format("image is {} x {}, but PlayCanvas' atlas is {} x {}", size->width, size->height,
                                 k_atlas_size, k_atlas_size),
                     "", ""};
    const auto image = decode_texture_image(bytes);
    if (!image) return image.error();
    const ImageView<const std::uint8_t> atlas{image->rgba.data(), k_atlas_size, k_atlas_size, 4};
    PlayCanvasAtlas maps;
    for (int l = 0; l < k_atlas_shiny_levels; ++l) maps.shiny.push_back(decode_rect(atlas, atlas_shiny_rect(l)));
    for (int l = 1; l <= k_atlas_rough_levels; ++l) maps.rough.push_back(decode_rect(atlas, atlas_rough_rect(l)));
    maps.diffuse = decode_rect(atlas, k_atlas_diffuse_rect);
    return maps;
}

Result<PlayCanvasAtlas> read_playcanvas_atlas(const std::filesystem::path& file) {
    const auto bytes = FileBytes::open(file, std::int64_t(1) << 26);
    if (!bytes) return bytes.error();
    auto maps = playcanvas_atlas((*bytes)->bytes());
    if (!maps) return maps.error().at(file.string());
    return maps;
}

}  // namespace domelight
