#pragma once

#include <csignal>
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

}  // namespace domelight
