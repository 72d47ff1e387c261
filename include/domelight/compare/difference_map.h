#pragma once
// Where two pictures differ, as `domelight compare A B` draws it.

#include "domelight/compare/picture_comparison.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace domelight {

/// A difference for each pixel.
struct DifferenceMap {
    ImageF values;           ///< one channel
    std::string title;       ///< "HDR-FLIP, mean 0.034"
    double high = 0;         ///< the upper end of the colour scale; 0: chosen by scale_for()
    bool is_signed = false;  ///< from -high to high
};
/// The names of the maps: hdr-flip, flip, difference, tone-mapped, relative, ssim, z; and auto, the first of hdr-flip,
/// flip and tone-mapped that there is.
const std::vector<std::string>& difference_maps();
/// A map by its name. Empty for any other name, and where the map is not available: "z" needs a picture with a
/// variance, "flip" and "hdr-flip" a comparison with PictureComparisonOptions::flip, and "hdr-flip" a picture of
/// radiance.
std::optional<DifferenceMap> difference_map(const PicturePair& pair, const PictureComparison& comparison,
                                            std::string_view name, int threads = 0);

/// A map as heat_picture() draws it. `high` > 0 is the upper end of the colour scale; 0: the map's own.
Image<std::uint8_t> heat_picture(const DifferenceMap& map, Mask mask, double high = 0);

/// Both pictures, their signed difference and the "auto" map side by side. `test_name`, `reference_name`: the files'.
Image<std::uint8_t> comparison_sheet(const PicturePair& pair, const PictureComparison& comparison,
                                     const std::string& test_name, const std::string& reference_name, int threads = 0);

}  // namespace domelight
