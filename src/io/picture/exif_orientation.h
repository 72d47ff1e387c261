#pragma once

#include <cstdint>
#include <span>

namespace domelight {

/// The tag Orientation (0x112) of Exif data that start with the header of a TIFF file: 1 as stored, 2 mirrored, 3 turned
/// by 180 degrees, 4 upside down, 5 to 8 with rows and columns changed. 1 where there is no such tag, or where it is
/// damaged. Exif 2.32, section 4.6.4.
int exif_orientation(std::span<const std::uint8_t> tiff);

}  // namespace domelight
