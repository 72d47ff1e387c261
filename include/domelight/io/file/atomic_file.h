#pragma once

#include "domelight/base/result.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

namespace domelight {

/// Writes a file by way of a temporary neighbour that replaces it once `write` has succeeded and every byte was
/// accepted and the file closed; removed otherwise (also on SIGINT and SIGTERM in a program that calls
/// remove_temporaries_on_signals). `write` gets the temporary path. Links are followed and stay links, also one that
/// leads to a file which does not exist yet: that file is created. A device or pipe is written to directly, and so is a
/// file that is itself a temporary one of a bake. Not flushed to the disk itself: that would take longer than a bake,
/// and only a power cut in the following seconds could tell.
/// Errors: a folder, links that lead in a circle, no folder to create the file in, what `write` returns; each names
/// `file`.
Result<void> write_file_atomically(const std::filesystem::path& file,
                                   const std::function<Result<void>(const std::filesystem::path&)>& write);
Result<void> write_file_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

/// To be called once at the start of a program. On SIGINT, SIGTERM and SIGHUP the temporary files of every
/// write_file_atomically under way are then removed before the program ends, and at a file-size limit (SIGXFSZ) the
/// write fails instead of ending the program.
void remove_temporaries_on_signals();

}  // namespace domelight
