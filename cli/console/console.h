#pragma once

#include "domelight/base/progress.h"
#include "domelight/base/result.h"

#include "cli/console/arguments.h"

#include <chrono>
#include <string>
#include <vector>

namespace domelight::cli {

enum ExitCode { exit_done = 0, exit_failed = 1, exit_usage = 2 };

/// The parts that every command has.
struct CommonOptions {
    std::optional<int> threads;
    bool json = false, quiet = false;
};
void add_common_options(Arguments& arguments, CommonOptions& options);
/// Errors: --threads out of range.
Result<void> check_common_options(const CommonOptions& options);

/// Prints "error: ..." to stderr and returns the exit code: 2 where the error's place is an option, else `otherwise`.
int print_error(const Error& error, int otherwise = exit_failed);
/// What every command begins with: reads its words and answers --help, wrong words and wrong common options. The exit
/// code where that was all; nothing where the command goes on.
std::optional<int> begin_command(Arguments& arguments, const std::vector<std::string>& words,
                                 const CommonOptions& options);

/// Prints "warning: ..." to stderr unless quiet.
void print_warnings(const std::vector<std::string>& warnings, const CommonOptions& options,
                    const std::string& place = "");

/// An option that does something only in some combinations.
struct OptionRule {
    const char* option;  ///< its long name: "--heat-max"
    bool works;          ///< in the combination that was given
    const char* with;    ///< what it goes with: "--heat"
};
/// Warns of each option that was given and does nothing, unless quiet.
void warn_of_idle_options(const Arguments& arguments, const std::vector<OptionRule>& rules,
                          const CommonOptions& options);

/// Behind the encoding of an OpenEXR image whose channels became 32-bit floats by the rule of fits_half().
inline constexpr const char* k_why_float_channels = "halves would clip at 65504";

/// "0:07", "12:30", "3:05:00".
std::string clock_text(double seconds);

/// Long work's bar on stderr, with the time left: drawn only on a terminal, never with --quiet or --json, removed at
/// the end.
class ProgressBar {
  public:
    ProgressBar(std::string title, const CommonOptions& options);
    ~ProgressBar();
    Progress callback();
    /// What is shown behind the bar from the next update on: "22 samples, noise 0.012".
    void detail(std::string text) { detail_ = std::move(text); }
    bool update(std::string_view stage, double done);

  private:
    std::string title_, detail_, stage_, shown_;
    std::chrono::steady_clock::time_point start_, drawn_;
    bool on_ = false;
};

}  // namespace domelight::cli
