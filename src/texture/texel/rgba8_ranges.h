#pragma once
// Colours beyond 1 in four bytes, the fourth one a scale: what engines without float textures read from a PNG.
//
//   rgbm  (8 a rgb)^2           PlayCanvas; up to 64
//   rgbp  ((8 - 7 a) rgb)^2     PlayCanvas; up to 64
//   rgbd  rgb^2.2 / a           Babylon.js; up to 255
//
// with rgb and a as shares of 255. A colour can be written with many scales: the one is taken that decodes nearest to
// it, out of the tightest (largest colours, so finest steps) and those just looser.

#include "domelight/base/vec.h"

#include <array>
#include <cstdint>

namespace domelight {

inline constexpr float k_rgbm_max = 64, k_rgbp_max = 64, k_rgbd_max = 255;

/// Scales that are tried. More would gain little, and neighbouring texels of about the same colour should have about
/// the same scale: a filter that blends the bytes before they are decoded is off by the product of both differences.
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
