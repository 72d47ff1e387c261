#pragma once
// Colours above 1 in four bytes, of which the fourth is a scale: for engines that read them from a PNG instead of a
// float texture.
//
//   rgbm  (8 a rgb)^2           PlayCanvas; up to 64
//   rgbp  ((8 - 7 a) rgb)^2     PlayCanvas; up to 64
//   rgbd  rgb^2.2 / a           Babylon.js; up to 255
//
// with rgb and a as shares of 255. A colour can be written with many scales. Of the smallest possible scale (which has
// the largest colours, and so the finest steps) and some larger ones, the one is taken that decodes nearest to the
// colour.

#include "domelight/base/vec.h"

#include <array>
#include <cstdint>

namespace domelight {

inline constexpr float k_rgbm_max = 64, k_rgbp_max = 64, k_rgbd_max = 255;

/// The number of scales that are tried. More would gain little, and neighbouring texels of similar colour should have
/// similar scales, because the error of a filter that blends the bytes before they are decoded is the product of both
/// differences.
inline constexpr int k_scales_tried = 8;

using Rgba8 = std::array<std::uint8_t, 4>;

/// Red, green, blue, scale. Channels from 0 to the encoding's largest value.
Rgba8 rgbm_from_rgb(const Vec3f& rgb);
Rgba8 rgbp_from_rgb(const Vec3f& rgb);
Rgba8 rgbd_from_rgb(const Vec3f& rgb);

/// Any bytes. rgbd: scale 0, which encoders never write, counts as 1.
Vec3f rgb_from_rgbm(const Rgba8& bytes);
Vec3f rgb_from_rgbp(const Rgba8& bytes);
Vec3f rgb_from_rgbd(const Rgba8& bytes);

}  // namespace domelight
