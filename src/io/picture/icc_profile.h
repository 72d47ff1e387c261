#pragma once

#include "domelight/base/result.h"

#include "io/picture/screen_colour.h"

#include <cstdint>
#include <span>

namespace domelight {

/// The colours of an ICC profile: curves and a matrix where it is made of those, by the code points that it may name
/// (PQ, HLG), otherwise by its tables. A profile of sRGB gives exactly sRGB, without a note.
/// Errors: damaged; neither of RGB nor of grey.
Result<ScreenColour> colour_of_icc_profile(std::span<const std::uint8_t> profile, int levels);

/// Whether the curves are sRGB's, and the primaries those of Rec. 709.
bool is_srgb(const ScreenColour& colour, int levels);
/// From colours whose columns are XYZ of the D50 white to linear Rec. 709; nothing where that changes no colour.
std::optional<Mat3> rec709_of_colourants(const Mat3& columns);

}  // namespace domelight
