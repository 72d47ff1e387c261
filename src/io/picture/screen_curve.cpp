#include "io/picture/screen_curve.h"

#include "image/srgb_curve.h"

#include <cmath>

namespace domelight {

std::vector<float> screen_curve(Decode decode, int levels) {
    std::vector<float> curve(levels);
    for (int i = 0; i < levels; ++i) {
        const double v = double(i) / (levels - 1);
        curve[std::size_t(i)] = float(decode == Decode::linear    ? v
                                      : decode == Decode::gamma22 ? std::pow(v, 2.2)
                                                                  : srgb_to_linear(v));
    }
    return curve;
}

std::vector<std::string> screen_warnings(const std::string& format, Decode decode) {
    std::vector<std::string> warnings{format + " is not HDR: values above 1 are clipped, so bright lights are too dim"};
    if (decode == Decode::automatic) warnings.push_back(format + " values are taken to be sRGB");
    return warnings;
}

}  // namespace domelight
