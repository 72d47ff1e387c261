#pragma once

#include "domelight/base/result.h"
#include "domelight/image/row_source.h"

#include <filesystem>

namespace domelight::cli {

/// Rows as an 8-bit sRGB picture (IEC 61966-2-1), clipped at 1: PNG or JPEG by the name's ending.
Result<void> write_8bit(const std::filesystem::path& file, RowSource& rows);

}  // namespace domelight::cli
