#pragma once

#include "domelight/base/result.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace domelight {

/// Writes a temporary file in the same folder and renames it to `file` once it has been written and closed without an
/// error. On any error the temporary file is removed, also on SIGINT and SIGTERM in a program that calls
/// remove_temporaries_on_signals(). `write` gets the path of the temporary file. Links are followed and stay links;
/// where one leads to a file that does not exist yet, that file is created. A device or a pipe is written to directly,
/// and so is a file that is itself temporary, as those of an unfinished bake are. The data is not flushed to the disk
/// (no fsync), because that would take longer than a bake: a power cut within the next few seconds can lose the file.
/// Errors: `file` is a folder; links that lead in a circle; no folder to create the file in; those of `write`. Each
/// names `file`.
Result<void> write_file_atomically(const std::filesystem::path& file,
                                   const std::function<Result<void>(const std::filesystem::path&)>& write);
Result<void> write_file_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
Result<void> write_file_atomically(const std::filesystem::path& file, std::string_view text);

/// Several files that appear together: each is written under a temporary name beside its place, and commit() moves all
/// of them. What has not been committed is removed with the object, or when a signal ends the program.
class FileGroup {
  public:
    FileGroup();
    ~FileGroup();
    FileGroup(const FileGroup&) = delete;
    FileGroup& operator=(const FileGroup&) = delete;

    /// Writes what will be `file`: `write` gets the path at which to write it, with the ending of `file`. Links are
    /// followed, as write_file_atomically() does. A device or a pipe is written to at once: that cannot be taken back.
    /// Errors name `file`: no folder to create it in; links that lead in a circle; what `write` returns.
    Result<void> write(const std::filesystem::path& file,
                       const std::function<Result<void>(const std::filesystem::path&)>& write);
    /// Moves the files to their places, in the order of write(). Errors, before anything is moved: a place is a folder.
    Result<void> commit();

  private:
    struct File;
    Result<std::filesystem::path> stage(const std::filesystem::path& file);

    std::vector<File> files_;
};

/// To be called once at the start of a program. On SIGINT, SIGTERM and SIGHUP the temporary files of every
/// write_file_atomically under way are then removed before the program ends, and at a file-size limit (SIGXFSZ) the
/// write fails instead of ending the program.
void remove_temporaries_on_signals();

}  // namespace domelight
