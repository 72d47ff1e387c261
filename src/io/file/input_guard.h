#pragma once

#include "domelight/base/result.h"

#include <filesystem>
#include <span>

namespace domelight {

/// An error that names `output` if it is one of the files `inputs` (by another name, or through a link, too): a name
/// that was made up for an output must not destroy what was read.
Result<void> check_not_an_input(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs);

}  // namespace domelight
