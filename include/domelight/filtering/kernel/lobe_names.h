#pragma once

#include "domelight/filtering/kernel/zonal_kernel.h"

#include <optional>
#include <string_view>

namespace domelight {

/// The lobe with this lobe_name(); nothing for any other name.
std::optional<Lobe> lobe_from_name(std::string_view name);

}  // namespace domelight
