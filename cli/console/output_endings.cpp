#include "cli/console/output_endings.h"

#include "domelight/engines/engine.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include "cli/console/arguments.h"
#include "io/file/output_place.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <set>
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

Result<void> check_folder(const char* option, const std::string& folder) {
    static const std::set<std::string> k_files = [] {
        std::set<std::string> endings{".json", ".glb"};
        for (const std::string& ending : light_and_screen_endings()) endings.insert(ending);
        for (const auto& row : EnumNames<Container>::table) endings.insert(container_extension(row.value));
        return endings;
    }();
    std::error_code ignored;
    if (std::filesystem::is_directory(folder, ignored)) return {};
    if (!k_files.contains(lower_case_extension(folder))) return {};
    return Error{
        fmt::format("\"{}\" is the name of a file, and several files are written into a folder", folder), option,
        fmt::format("Name a folder: {} {}.", option, std::filesystem::path(folder).replace_extension().string())};
}

Result<void> check_output_places(const std::vector<std::string>& outputs,
                                 const std::vector<std::filesystem::path>& inputs) {
    std::vector<std::filesystem::path> files;
    for (const std::string& output : outputs)
        if (!output.empty()) files.emplace_back(output);
    return check_output_files(files, inputs);
}

}  // namespace domelight::cli
