#pragma once

#include "domelight/base/result.h"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace domelight {

bool is_data_uri(std::string_view uri);

/// The bytes of "data:[type][;base64],...". Errors: not base64.
Result<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri);

/// The file that a relative uri names. Errors: a scheme, an absolute path, or a path that leaves `folder` (by "..", or
/// by a symbolic link).
Result<std::filesystem::path> path_of_uri(std::string_view uri, const std::filesystem::path& folder);

}  // namespace domelight
