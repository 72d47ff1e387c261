#pragma once

#include "domelight/compare/read_error.h"

#include "io/file/json.h"

namespace domelight {

/// {"relative_rmse", "largest", "levels": [{"roughness", "level", "relative_rmse", "largest"}], "between": [...]}.
Json read_errors_json(const ReadErrors& errors);

}  // namespace domelight
