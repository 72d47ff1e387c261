#pragma once

#include "domelight/base/result.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace domelight::cli {

/// Endings of files that hold radiance (.hdr, .exr), then those of pictures for a screen (write_image.h).
std::span<const std::string> light_and_screen_endings();

/// An error at `option` unless the file's name ends in one of `accepted`, in any case. An empty name is accepted: the
/// option was not given.
Result<void> check_ending(const char* option, const std::string& file, std::span<const std::string> accepted);

/// An error at `option` if the name of a folder for results ends as a file's would (.hdr, .exr, .ktx2, .json, ...) and
/// no folder has that name.
Result<void> check_folder(const char* option, const std::string& folder);

/// check_output_files(), before the work, for the outputs that were named; an empty name is one that was not given.
Result<void> check_output_places(const std::vector<std::string>& outputs,
                                 const std::vector<std::filesystem::path>& inputs = {});

}  // namespace domelight::cli
