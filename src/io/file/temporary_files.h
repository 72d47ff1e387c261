#pragma once

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

  private:
    struct Slot;
    friend void remove_registered_temporaries();
    Slot* slot_ = nullptr;
};

/// Unlinks every registered file. Async-signal-safe.
void remove_registered_temporaries();

}  // namespace domelight
