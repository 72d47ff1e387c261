#pragma once

#include "domelight/base/result.h"

#include <filesystem>
#include <string_view>

namespace domelight {

/// `path`, which a file in `folder` names, made canonical. Errors: it does not lie in `folder`: an absolute path, one
/// with "..", or a symbolic link that leads out. `shown`: what messages call it.
Result<std::filesystem::path> path_inside(const std::filesystem::path& path, const std::filesystem::path& folder,
                                          std::string_view shown);

}  // namespace domelight
