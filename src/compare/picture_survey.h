#pragma once

#include "domelight/base/vec.h"
#include "domelight/compare/picture_reader.h"

#include <cstdint>

namespace domelight {

/// What the pixels of a picture hold. Range and mean are of finite values only.
struct PictureSurvey {
    float least = 0, largest = 0;                               ///< over all channels
    Vec3d mean;                                                 ///< over all pixels
    std::int64_t not_a_number = 0, infinite = 0, negative = 0;  ///< pixels with such a channel
    double ev = 0;                                              ///< stops that suit a screen (exposure_meter.h)
    double coverage = 1;                                        ///< mean opacity; 1 where there is none
    bool cut_out = false;                                       ///< Picture::cut_out
};
PictureSurvey survey_picture(const Picture& picture);

}  // namespace domelight
