#pragma once

#include <string>

namespace domelight {

/// A field of an options struct as errors and warnings name it, in their place as well as in their text: between
/// backticks, "`irradiance_size`". A program that has other names for the fields puts them there, as the command line
/// does with --irradiance-size.
inline std::string field_place(const std::string& name) {
    return "`" + name + "`";
}

}  // namespace domelight
