#pragma once

#include "cli/console/console.h"

#include <filesystem>

namespace domelight::cli {

/// Describes the folder of a set of probes. The exit code is that of a failure where files are not as they were written.
int info_probes(const std::filesystem::path& folder, const CommonOptions& options);

}  // namespace domelight::cli
