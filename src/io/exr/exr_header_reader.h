#pragma once

#include "domelight/base/result.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace domelight {

struct ReaderOptions;

/// Checks the headers of an OpenEXR file before the OpenEXR library reads them: the library allocates whatever size a
/// header states, and here that size is first compared with the file.
struct ExrPreflight {
    /// The file's first bytes, up to the end of the headers, with the type names of all attributes that decoding does
    /// not need replaced by unknown ones. The library stores attributes of unknown type as plain bytes, so it ignores
    /// sizes inside them (those of a preview image or a string vector).
    std::vector<char> headers;
};

/// Errors: no end of the headers, attributes that reach past the end of the file, windows or tiles of impossible size,
/// more chunks than the file could index, blocks or tiles of more than `max_bytes` when decoded, more texels than the
/// file's bytes can hold by its compression (PIZ and DWA have no bound: a chunk of any size may take some bytes).
Result<ExrPreflight> check_exr_headers(std::span<const std::uint8_t> file, std::int64_t max_bytes);

/// A window of texels, with its last ones: x_min, y_min, x_max, y_max.
using ExrWindow = std::array<std::int32_t, 4>;

/// Errors: the display window adds more than four times the texels of the data window that it shows, and more than
/// `options` allow: max_black, or what max_bytes hold as RGB floats.
Result<void> check_exr_black(const ExrWindow& display, const ExrWindow& data, const ReaderOptions& options);

}  // namespace domelight
