#pragma once

#include "domelight/base/names.h"

namespace domelight {

/// What becomes of negative radiance in a file. It is no light, but what lossy compression and sharpening leave beside
/// bright lights. Colours outside of Rec. 709, which have negative channels there, are clamped unless they are kept.
enum class Negatives {
    balance,  ///< 0, and what that adds is taken from the brighter texels round it, so that their light stays the same
    clamp,    ///< 0, which adds light
    keep,     ///< as it is: for conversions to formats that hold it
};
template <>
struct EnumNames<Negatives> {
    static constexpr const char* kind = "a treatment of negative values";
    static constexpr NamedValue<Negatives> table[] = {
        {Negatives::balance, "balance"}, {Negatives::clamp, "clamp"}, {Negatives::keep, "keep"}};
};

}  // namespace domelight
