#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace domelight {

/// A row of RGBE texels, given as four planes of bytes, to interleaved float RGB: channel c = mantissa_c 2^(e - 136)
/// scale[c], and 0 where e <= 1 (0 by definition of the format; 2^-135 lies below float's normal range). The mantissa
/// is taken as it is, without half a step added, as the tools of computer graphics do (Radiance itself adds 1/2).
///
/// planes   red, green, blue, exponent, each `plane_stride` bytes after the one before
/// out      3 * width floats
void rgbe_to_float(const std::uint8_t* planes, std::size_t plane_stride, int width, const std::array<float, 3>& scale,
                   float* out);
/// The same without SIMD: the same bits.
void rgbe_to_float_scalar(const std::uint8_t* planes, std::size_t plane_stride, int width,
                          const std::array<float, 3>& scale, float* out);

}  // namespace domelight
