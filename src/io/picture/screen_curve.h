#pragma once

#include "io/image_reader.h"

#include <string>
#include <vector>

namespace domelight {

// Functions shared by the readers of pictures for a screen. Such pictures are accepted with a warning, because
// everything brighter than the screen's white was clipped when they were written.

/// The linear value, 0..1, of each of `levels` codes. Precondition: not one of the decodings for textures only.
std::vector<float> screen_curve(Decode decode, int levels);

/// "PNG is not HDR: ..." and, where the curve was not chosen, what was assumed.
std::vector<std::string> screen_warnings(const std::string& format, Decode decode);

}  // namespace domelight
