#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace domelight {

/// A format of pictures that is not read.
struct ForeignFormat {
    std::string name;  ///< "AVIF", "TIFF", ...
    std::string hint;  ///< with what to convert such a file
};

/// The format of a file that begins (TGA: or ends) with these bytes, if it is a known one that is not read.
std::optional<ForeignFormat> foreign_format(std::span<const std::uint8_t> bytes);

}  // namespace domelight
