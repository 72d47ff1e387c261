#pragma once

#include "domelight/base/result.h"

#include <string>
#include <vector>

namespace domelight::cli {

/// The option that sets a field of the library's options: "irradiance_size" is set by --irradiance-size.
std::string option_of_field(std::string field);

/// A text of the library in which the fields between backticks have become options: "Use `format` ktx2." tells of
/// --format.
std::string with_options(const std::string& text);
std::vector<std::string> with_options(std::vector<std::string> texts);

/// An error of the library as the command line tells of it.
Error with_options(const Error& error);

}  // namespace domelight::cli
