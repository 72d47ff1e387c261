#pragma once

#include "domelight/base/result.h"

#include "image/colour_primaries.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// The contents of the text before a Radiance picture's texels.
struct HdrHeader {
    bool xyze = false;  ///< texels are CIE XYZ, not RGB
    /// A program of Radiance wrote the picture. Its XYZ are photometric (Y in cd/m²), with equal energy as grey.
    bool by_radiance = false;
    double gamma = 1;  ///< GAMMA, as ImageMagick writes it: texels are light to this power
    std::array<double, 3> applied{
        1, 1, 1};  ///< product of all EXPOSURE and COLORCORR lines: the factor on the radiance of each channel
    std::optional<ColourPrimaries> primaries;  ///< PRIMARIES, for RGB
    int width = 0, height = 0;
    bool columns = false;  ///< scanlines are columns of the image (the resolution line names X first)
    bool flip_x = false;   ///< -X: x runs from right to left
    bool flip_y = false;   ///< +Y: y runs from the bottom up
    std::size_t data_offset = 0;
    std::vector<std::string> warnings;
};

/// Errors: no end within 1 MB, a FORMAT that is neither RGBE nor XYZE, no resolution line, sizes out of range.
Result<HdrHeader> read_hdr_header(std::span<const std::uint8_t> file);

}  // namespace domelight
