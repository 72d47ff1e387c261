#pragma once

#include <string>

namespace domelight::cli {

/// While an object of this class exists, the first SIGINT or SIGTERM only asks the work to stop, so that it can end in
/// order; a second one ends the program at once. There can be only one such object at a time.
class Interruption {
  public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    /// Whether a signal came.
    static bool wanted();
    /// Prints "interrupted: WHAT" and ends the program by the signal that came, as its parent expects (a shell reports
    /// 130 after Ctrl-C). Returns 1 only where it was none.
    int end(const std::string& what);

  private:
    void restore();
};

}  // namespace domelight::cli
