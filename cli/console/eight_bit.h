#pragma once

#include "domelight/base/result.h"
#include "domelight/image/row_source.h"

#include <filesystem>

namespace domelight::cli {

/// Rows as an 8-bit sRGB PNG (IEC 61966-2-1), clipped at 1.
Result<void> write_8bit(const std::filesystem::path& file, RowSource& rows);

}  // namespace domelight::cli
