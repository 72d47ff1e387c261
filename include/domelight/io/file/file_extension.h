#pragma once

#include <filesystem>
#include <string>

namespace domelight {

/// ASCII letters in lower case; everything else as it is.
std::string lower_case(std::string text);

/// The ending of a file's name with its dot, in lower case: ".png". Empty where there is none.
std::string lower_case_extension(const std::filesystem::path& file);

}  // namespace domelight
