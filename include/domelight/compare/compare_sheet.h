#pragma once

#include "domelight/compare/metrics.h"
#include "domelight/image/image.h"

#include <cstdint>
#include <string>

namespace domelight {

/// A map of numbers and the colours in which it is shown.
struct HeatMap {
    ImageView<const float> values;  ///< one channel
    std::string title;              ///< "HDR-FLIP, mean 0.034"
    double high = 1;                ///< the value at the upper end of the colour scale; > 0
    bool is_signed = false;         ///< from -high to high (blue, white, red); else from 0
};

/// The upper end of a colour scale: the least number of the form 1, 2 or 5 times a power of ten that is not below the
/// 99.5th percentile of |value| over the finite pixels that count (of the largest |value|, if this percentile is 0); 1
/// if all are 0 or none counts.
double scale_for(ImageView<const float> values, Mask mask = {});

/// A heat map at full size (small ones enlarged by a whole number) above its labelled colour scale. Pixels outside the
/// mask are grey.
Image<std::uint8_t> heat_picture(const HeatMap& map, Mask mask = {});

/// The contents of a comparison sheet: two pictures as on a display at the same exposure, their signed difference, and
/// a map of the perceived difference.
struct CompareSheet {
    std::string title, subtitle;
    std::string test_name, reference_name;
    ImageView<const float> test, reference;  ///< linear radiance, 3 channels
    double exposure_ev = 0;
    bool tone_map = true;  ///< false: values are display-linear already and only clipped
    HeatMap difference, perceived;
    Mask mask;
};
Image<std::uint8_t> compare_sheet(const CompareSheet& sheet, int threads = 0);

}  // namespace domelight
