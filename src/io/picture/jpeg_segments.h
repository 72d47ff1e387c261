#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace domelight {

/// A segment of a JPEG file (ISO 10918-1, B.1.1.4).
struct JpegSegment {
    std::uint8_t marker = 0;                 ///< 0xe1 for APP1, ...
    std::span<const std::uint8_t> contents;  ///< without the marker and the length
};

/// The segments of the JPEG at the start of `file`, up to the first scan or to the first that is damaged.
std::vector<JpegSegment> jpeg_segments(std::span<const std::uint8_t> file);

/// What follows `name` in a segment that begins with it; empty: it does not begin so.
std::span<const std::uint8_t> contents_after(const JpegSegment& segment, std::uint8_t marker, std::string_view name);

/// The ICC profile in the segments APP2, put together (ICC.1:2022, annex B.4). Empty: none, or a part is missing.
std::vector<std::uint8_t> jpeg_icc_profile(const std::vector<JpegSegment>& segments);

/// Exif's orientation in the segments APP1, 1 to 8.
int jpeg_orientation(const std::vector<JpegSegment>& segments);

}  // namespace domelight
