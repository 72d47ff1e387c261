#pragma once

#include "domelight/base/result.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

namespace domelight {

/// Writes a file by way of a temporary neighbour that replaces it once `write` has succeeded and every byte was
/// accepted and the file closed; removed otherwise (also on SIGINT and SIGTERM in a program that calls
/// remove_temporaries_on_signals). `write` gets the temporary path. A link is followed; a device or pipe is written to
/// directly. Not flushed to the disk itself: that would take longer than a bake, and only a power cut in the following
/// seconds could tell.
Result<void> write_file_atomically(const std::filesystem::path& file,
                                   const std::function<Result<void>(const std::filesystem::path&)>& write);
Result<void> write_file_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

/// For programs, once at the start: SIGINT, SIGTERM and SIGHUP then remove the temporary files of every
/// write_file_atomically under way before they end the program, and a file-size limit (SIGXFSZ) fails the write instead
/// of killing it.
void remove_temporaries_on_signals();

}  // namespace domelight
