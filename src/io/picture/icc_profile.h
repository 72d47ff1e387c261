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

}  // namespace domelight
