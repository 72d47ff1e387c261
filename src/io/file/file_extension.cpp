#include "domelight/io/file/file_extension.h"

#include <algorithm>

namespace domelight {

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return text;
}

std::string lower_case_extension(const std::filesystem::path& file) {
    return lower_case(file.extension().string());
}

}  // namespace domelight
