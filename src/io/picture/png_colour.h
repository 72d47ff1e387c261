#pragma once

#include "io/picture/screen_colour.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace domelight {

/// The contents of the first chunk of that type, or nothing. Chunks are found by their lengths; check sums are not read.
std::optional<std::span<const std::uint8_t>> find_png_chunk(std::span<const std::uint8_t> file, std::string_view type);

/// How a PNG's codes become light. The first of these counts that is there and can be used: cICP, iCCP, sRGB, gAMA with
/// cHRM (Portable Network Graphics, third edition, section 4.3). What cannot be used is noted. `icc_profile` is iCCP's
/// profile, decompressed; empty: none.
/// Returns also whether the file says nothing, so that sRGB is assumed.
struct PngColour {
    ScreenColour colour;
    bool assumed = false;
};
PngColour colour_of_png(std::span<const std::uint8_t> file, std::span<const std::uint8_t> icc_profile, int levels);

}  // namespace domelight
