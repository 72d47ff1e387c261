#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace domelight {

// What Exif data and their like say, which start with the header of a TIFF file. Exif 2.32, section 4.6.

/// The tag Orientation (0x112): 1 as stored, 2 mirrored, 3 turned by 180 degrees, 4 upside down, 5 to 8 with rows and
/// columns changed. 1 where there is no such tag, or where it is damaged.
int exif_orientation(std::span<const std::uint8_t> tiff);

/// How much brighter than white a photograph of an iPhone is at most, from the tags 33 and 48 of Apple's maker note;
/// nothing where these are missing. "Applying Apple HDR effect to your photos" (Apple's developer documentation).
std::optional<double> apple_headroom(std::span<const std::uint8_t> tiff);

/// Offsets of a file's pictures in a Multi-Picture index (CIPA DC-007, section 5.2.3), from its start; that of the first
/// picture is 0.
std::vector<std::size_t> multi_picture_offsets(std::span<const std::uint8_t> index);

}  // namespace domelight
