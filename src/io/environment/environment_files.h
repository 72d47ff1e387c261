#pragma once

#include "domelight/io/environment/open_environment.h"

#include <filesystem>
#include <vector>

namespace domelight {

/// The files that make up an environment: of a folder of six faces these, and six faces in their order, so that a hash
/// does not depend on how they were named; else `files` themselves.
std::vector<std::filesystem::path> environment_files(std::vector<std::filesystem::path> files,
                                                     const EnvironmentOptions& options = {});

}  // namespace domelight
