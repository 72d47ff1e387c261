#pragma once

#include "domelight/base/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// Checks the headers of an OpenEXR file before the OpenEXR library reads them: the library allocates whatever size a
/// header states, and here that size is first compared with the file.
struct ExrPreflight {
    /// The file's first bytes, up to the end of the headers, with the type names of all attributes that decoding does
    /// not need replaced by unknown ones. The library stores attributes of unknown type as plain bytes, so it ignores
    /// sizes inside them (those of a preview image or a string vector).
    std::vector<char> headers;
};

/// Errors: no end of the headers, attributes that reach past the end of the file, windows or tiles of impossible size,
/// more chunks than the file could index, blocks or tiles of more than `max_bytes` when decoded.
Result<ExrPreflight> check_exr_headers(std::span<const std::uint8_t> file, std::int64_t max_bytes);

}  // namespace domelight
