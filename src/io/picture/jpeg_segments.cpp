#include "io/picture/jpeg_segments.h"

#include "io/picture/exif.h"

#include <algorithm>

namespace domelight {

std::vector<JpegSegment> jpeg_segments(std::span<const std::uint8_t> file) {
    constexpr std::uint8_t k_scan = 0xda, k_end = 0xd9;
    std::vector<JpegSegment> segments;
    for (std::size_t at = 2; at + 4 <= file.size() && file[at] == 0xff;) {
        const std::uint8_t marker = file[at + 1];
        if (marker == 0xff) {  // fill
            ++at;
            continue;
        }
        if (marker == k_scan || marker == k_end) break;
        const std::size_t length = std::size_t(file[at + 2]) << 8 | file[at + 3];
        if (length < 2 || length > file.size() - at - 2) break;
        segments.push_back({marker, file.subspan(at + 4, length - 2)});
        at += 2 + length;
    }
    return segments;
}

std::span<const std::uint8_t> contents_after(const JpegSegment& segment, std::uint8_t marker, std::string_view name) {
    const auto& contents = segment.contents;
    if (segment.marker != marker || contents.size() < name.size()) return {};
    const bool named = std::equal(name.begin(), name.end(), contents.begin(),
                                  [](char a, std::uint8_t b) { return std::uint8_t(a) == b; });
    return named ? contents.subspan(name.size()) : std::span<const std::uint8_t>();
}

std::vector<std::uint8_t> jpeg_icc_profile(const std::vector<JpegSegment>& segments) {
    using namespace std::string_view_literals;
    std::vector<std::uint8_t> profile;
    std::size_t parts = 0, expected = 0;
    for (const JpegSegment& segment : segments) {
        const auto part = contents_after(segment, 0xe2, "ICC_PROFILE\0"sv);
        if (part.size() < 2) continue;
        if (part[0] != ++parts) return {};
        expected = part[1];
        profile.insert(profile.end(), part.begin() + 2, part.end());
    }
    return parts == expected ? profile : std::vector<std::uint8_t>();
}

int jpeg_orientation(const std::vector<JpegSegment>& segments) {
    using namespace std::string_view_literals;
    for (const JpegSegment& segment : segments)
        if (const auto exif = contents_after(segment, 0xe1, "Exif\0\0"sv); !exif.empty()) return exif_orientation(exif);
    return 1;
}

}  // namespace domelight
