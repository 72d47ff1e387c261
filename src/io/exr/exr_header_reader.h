#pragma once

#include "domelight/base/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// The headers of an OpenEXR file, looked through before the OpenEXR library sees them: the library allocates what a
/// header asks for, and this compares what is asked for with the file first.
struct ExrPreflight {
    /// The file's first bytes, up to the end of the headers, with the type name of every attribute that decoding does
    /// not need crossed out. The library keeps attributes of unknown type as plain bytes, so it does not act on sizes
    /// that are written inside them (a preview image's, a string vector's).
    std::vector<char> headers;
};

/// Errors: no end of the headers, attributes that reach past the end of the file, windows or tiles of impossible size,
/// more chunks than the file could index, blocks or tiles of more than `max_bytes` when decoded.
Result<ExrPreflight> check_exr_headers(std::span<const std::uint8_t> file, std::int64_t max_bytes);

}  // namespace domelight
