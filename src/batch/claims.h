#pragma once

#include "domelight/base/result.h"

#include <filesystem>
#include <string>

namespace domelight {

/// Claims on jobs, by which several runs of one plan share the work: a lock on one byte of a file, at an offset that is
/// made of the job's id. The system releases the lock when the process ends, however it ends, also on another machine
/// that shares the file system.
///
/// Open-file-description locks (fcntl, F_OFD_SETLK), which, unlike flock(), lock single bytes, and which belong to this
/// object and the processes forked from it, so that a claim lasts until the last of them has ended.
class Claims {
  public:
    /// Opens or creates the file. Errors: it cannot be created; the file system has no locks.
    static Result<Claims> open(const std::filesystem::path& file);
    ~Claims();
    Claims(Claims&& other) noexcept;
    Claims& operator=(Claims&&) = delete;

    /// Whether the job is now claimed by this object. False: another one has it.
    bool take(const std::string& job);
    void release(const std::string& job);

  private:
    explicit Claims(int descriptor) : descriptor_(descriptor) {}
    int descriptor_ = -1;
};

}  // namespace domelight
