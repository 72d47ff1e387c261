#pragma once

#include "io/image_reader.h"

#include <string>
#include <vector>

namespace domelight {

// Functions shared by the readers of pictures for a screen. Such pictures are accepted with a warning, because
// everything brighter than the screen's white was clipped when they were written.

/// The linear value, 0..1, of each of `levels` codes. `decode`: auto and srgb (IEC 61966-2-1), gamma22 (x^2.2) or
/// linear.
std::vector<float> screen_curve(const std::string& decode, int levels);

/// "PNG is not HDR: ..." and, where the curve was not chosen, what was assumed.
std::vector<std::string> screen_warnings(const std::string& format, const std::string& decode);

}  // namespace domelight
