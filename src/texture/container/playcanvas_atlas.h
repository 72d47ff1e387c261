#pragma once
// PlayCanvas' envAtlas: 512 x 512 texels of RGBP with lat-long maps side by side, each with a seam of one texel that
// repeats what lies past its edge (its engine: src/scene/graphics/env-lighting.js, envAtlas shader chunk).
//
//   (0, 0) 512 x 256            the environment, for mirrors; each next half as large, at x += h, y += h
//   (0, 256) 256 x 128          roughness of level 1; each next half as large, at y += h
//   (128, 384) 64 x 32          E / pi

#include "domelight/base/result.h"
#include "domelight/image/image.h"
#include "domelight/texture/texture.h"

#include "io/file/byte_source.h"
#include "texture/texel_order.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace domelight {

inline constexpr int k_atlas_size = 512, k_atlas_shiny_levels = 7, k_atlas_rough_levels = 6;

/// Part of the atlas, its seam included.
struct AtlasRect {
    int x, y, width, height;
};
AtlasRect atlas_shiny_rect(int level);  ///< 0 to k_atlas_shiny_levels - 1
AtlasRect atlas_rough_rect(int level);  ///< 1 to k_atlas_rough_levels
inline constexpr AtlasRect k_atlas_diffuse_rect{128, 384, 64, 32};

/// RGBP bytes. `maps`: level 0 (the environment) and levels 1 to 6, lat-long and at least as large as their places;
/// `diffuse`: E / pi; `order` leads to PlayCanvas' convention. `reports`: one for each of `maps`.
Image<std::uint8_t> make_playcanvas_atlas(std::span<const FilteredMap> maps, const FilteredMap& diffuse,
                                          const TexelOrder& order, int threads,
                                          std::vector<EncodingReport>* reports = nullptr);
Result<void> write_playcanvas_atlas(const std::filesystem::path& file, const Image<std::uint8_t>& atlas);

/// The decoded contents of an atlas without the seams: lat-long maps in PlayCanvas' convention.
struct PlayCanvasAtlas {
    std::vector<ImageF> shiny, rough;
    ImageF diffuse;
};
/// Errors: the file is not a PNG of 512 x 512, or it is broken.
Result<PlayCanvasAtlas> playcanvas_atlas(std::span<const std::uint8_t> bytes);
Result<PlayCanvasAtlas> read_playcanvas_atlas(const std::filesystem::path& file);

}  // namespace domelight
