#pragma once

#include "domelight/base/result.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

namespace domelight {

/// Writes a temporary file in the same folder, which replaces `file` once `write` has succeeded, every byte was
/// accepted and the file is closed. On failure the temporary file is removed (in a program that calls
/// remove_temporaries_on_signals also on SIGINT and SIGTERM). `write` is given the temporary path. A link is followed;
/// a device or pipe is written to directly. The file is not flushed to the disk: that would take longer than a bake,
/// and matters only if the power fails within the next seconds.
Result<void> write_file_atomically(const std::filesystem::path& file,
                                   const std::function<Result<void>(const std::filesystem::path&)>& write);
Result<void> write_file_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

/// To be called once at the start of a program. On SIGINT, SIGTERM and SIGHUP the temporary files of every
/// write_file_atomically under way are then removed before the program ends, and at a file-size limit (SIGXFSZ) the
/// write fails instead of ending the program.
void remove_temporaries_on_signals();

}  // namespace domelight
