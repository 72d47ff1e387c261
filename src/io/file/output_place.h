#pragma once

#include "domelight/base/result.h"

#include <filesystem>
#include <span>
#include <vector>

namespace domelight {

/// Whether `file` can be written by write_file_atomically(), as far as that is known before there is anything to
/// write: so that a long computation does not end with an error that its first second could have told. Removes what
/// killed programs have left in the folder (remove_abandoned_temporaries()).
/// Errors, which name `file`: it is a folder; its folder is missing or must not be written to; the disk is full.
Result<void> check_output_file(const std::filesystem::path& file);

/// The same for a folder for results, which need not exist yet. Errors: it is a file; it must not be written to, or
/// cannot be created; the disk is full.
Result<void> check_output_folder(const std::filesystem::path& folder);

/// check_output_file() for each of several outputs. Errors also: two of them are one file; one is a file of `inputs`.
Result<void> check_output_files(std::span<const std::filesystem::path> files,
                                std::span<const std::filesystem::path> inputs = {});

}  // namespace domelight
