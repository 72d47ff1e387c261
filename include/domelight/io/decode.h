#pragma once

#include "domelight/base/names.h"

namespace domelight {

/// What the numbers of a picture of eight bits a channel mean.
enum class Decode {
    automatic,  ///< what the file says (profile, gamma, format); otherwise sRGB, with a warning
    srgb,       ///< IEC 61966-2-1
    gamma22,    ///< the power 2.2
    linear,     ///< the light itself
    rgbm,       ///< Encoding::rgbm; this one and the next two are for textures only
    rgbd,       ///< Encoding::rgbd
    rgbp,       ///< Encoding::rgbp
};
template <>
struct EnumNames<Decode> {
    static constexpr const char* kind = "a decoding";
    static constexpr NamedValue<Decode> table[] = {
        {Decode::automatic, "auto"}, {Decode::srgb, "srgb"}, {Decode::gamma22, "gamma22"}, {Decode::linear, "linear"},
        {Decode::rgbm, "rgbm"},      {Decode::rgbd, "rgbd"}, {Decode::rgbp, "rgbp"},
    };
};

}  // namespace domelight
