#include "cli/console/output_endings.h"

#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include "cli/console/arguments.h"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

namespace domelight::cli {

std::span<const std::string> light_and_screen_endings() {
    static const std::vector<std::string> all = [] {
        std::vector<std::string> endings{".hdr", ".exr"};
        const auto screen = screen_picture_extensions();
        endings.insert(endings.end(), screen.begin(), screen.end());
        return endings;
    }();
    return all;
}

Result<void> check_ending(const char* option, const std::string& file, std::span<const std::string> accepted) {
    if (file.empty() || std::find(accepted.begin(), accepted.end(), lower_case_extension(file)) != accepted.end())
        return {};
    return Error{fmt::format("\"{}\" ends in none of the formats", file), option,
                 "Accepted: " + join({accepted.begin(), accepted.end()}, ", ") + "."};
}

}  // namespace domelight::cli
