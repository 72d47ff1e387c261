#pragma once

#include "domelight/base/names.h"

namespace domelight {

/// What a map of light holds.
enum class Quantity { radiance, irradiance, irradiance_over_pi };
template <>
struct EnumNames<Quantity> {
    static constexpr const char* kind = "a quantity";
    static constexpr NamedValue<Quantity> table[] = {
        {Quantity::radiance, "radiance"},
        {Quantity::irradiance, "irradiance"},
        {Quantity::irradiance_over_pi, "irradiance_over_pi"},
    };
};

}  // namespace domelight
