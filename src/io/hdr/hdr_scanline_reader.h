#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace domelight {

/// One scanline of a Radiance picture, in any of the encodings that may follow one another in a file: new run-length
/// (each component by itself, 8 <= width < 32768, marked by 2 2), old run-length (a texel 1 1 1 n repeats the one
/// before; consecutive ones shift n by 8 bits), or flat. "RADIANCE Reference, Picture File Format"; Ward, "Real
/// Pixels", Graphics Gems II (1991).
struct ScanlineStep {
    std::size_t bytes = 0;        ///< the number of bytes of the scanline
    const char* error = nullptr;  ///< the fault of the scanline, or null
};

/// Where the scanline at the start of `data` ends, without decoding it.
ScanlineStep skip_hdr_scanline(std::span<const std::uint8_t> data, int width);

/// Bytes that decoding may touch beyond the last plane: short runs are written in whole blocks.
inline constexpr std::size_t k_scanline_slack = 128;

/// Decodes it into four planes of `width` bytes (red, green, blue, exponent), each `plane_stride` >= width apart, with
/// k_scanline_slack bytes after the last.
ScanlineStep decode_hdr_scanline(std::span<const std::uint8_t> data, int width, std::uint8_t* planes,
                                 std::size_t plane_stride);

/// The least number of bytes that a scanline of `width` texels can have, so that a wrong header is detected before
/// memory is allocated for it.
std::size_t least_hdr_scanline_bytes(int width);

}  // namespace domelight
