#pragma once

#include "domelight/base/result.h"

#include <csignal>
#include <filesystem>
#include <memory>
#include <string>

namespace domelight {

/// The path of a file that must not outlive the program: while an object of this class lives,
/// remove_temporaries_on_signals() has its file removed when the program is interrupted.
class TemporaryFileGuard {
  public:
    explicit TemporaryFileGuard(const std::string& path);
    ~TemporaryFileGuard();
    TemporaryFileGuard(const TemporaryFileGuard&) = delete;
    TemporaryFileGuard& operator=(const TemporaryFileGuard&) = delete;

    /// Whether an object of this class lives for exactly this path.
    static bool guards(const std::string& path);

  private:
    struct Slot;
    friend void remove_registered_temporaries();
    Slot* slot_ = nullptr;
};

/// While an object of this class lives, a signal that ends the program waits with removing the temporary files: create
/// a guarded file only meanwhile, or it may appear after the others were removed. Keep it short; do not nest.
class TemporaryFileCreation {
  public:
    TemporaryFileCreation();
    ~TemporaryFileCreation();
    TemporaryFileCreation(const TemporaryFileCreation&) = delete;
    TemporaryFileCreation& operator=(const TemporaryFileCreation&) = delete;

  private:
    sigset_t signals_before_;
};

/// Unlinks every registered file. Async-signal-safe.
void remove_registered_temporaries();

/// A temporary file that is to become `target`; removed with this object, or when a signal ends the program.
struct TemporaryFile {
    std::string path;
    std::unique_ptr<TemporaryFileGuard> guard;
};

/// Names a temporary file beside `target`, which nobody has created yet: ".target.domelight-MARK-PID-N.tmp" and the
/// ending of `target`, because some writers depend on it. MARK tells machines and containers apart that share a disk.
std::filesystem::path temporary_name(const std::filesystem::path& target);

/// Creates it, empty. Its mode is the one an ordinary new file gets, or that of the file which it is to replace.
Result<TemporaryFile> create_temporary(const std::filesystem::path& target);

/// Removes the temporary files in `folder` that programs of this library left which were killed: only regular files of
/// this user whose name is one of temporary_name() and whose process has ended on this machine.
void remove_abandoned_temporaries(const std::filesystem::path& folder);

/// "cannot DOING: " and what the system's error means.
Error system_error(const char* doing, int code);

/// Whether something is there that is neither a file nor a folder. A device or a pipe (/dev/stdout, a named pipe) cannot
/// be replaced, only written to.
bool is_device(const std::filesystem::file_status& status);

/// Where a chain of links ends, whether there is a file or not: the last name alone may be a link that leads nowhere.
/// Errors: links that lead in a circle.
Result<std::filesystem::path> end_of_links(std::filesystem::path file);

}  // namespace domelight
