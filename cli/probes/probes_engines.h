#pragma once

#include "cli/probes/probes_options.h"

#include <filesystem>

namespace domelight::cli {

/// Whether the command's first argument is the folder of a set of probes, to be written for engines, and not a scene.
bool names_a_set(const ProbesWords& words);

/// Checks the words of a command that writes a set for engines. Errors: no engine; an option of the capture.
Result<void> check_engine_words(const ProbesWords& words, const Arguments& arguments);

/// Writes the set in the folder `set` for each engine of --for: into `folder` if there is one, and it is not the set's
/// own folder; else into folders of their names in it. Returns the program's exit code.
int write_for_engines(const ProbesWords& words, const std::filesystem::path& set, const std::filesystem::path& folder);

}  // namespace domelight::cli
