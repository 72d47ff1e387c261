#pragma once

#include "domelight/progress.h"
#include "domelight/result.h"

#include "arguments.h"

#include <string>
#include <vector>

namespace domelight::cli {

enum ExitCode { exit_done = 0, exit_failed = 1, exit_usage = 2 };

/// What every command has.
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

/// Long work's bar on stderr: drawn only on a terminal, never with --quiet or --json, removed at the end.
class ProgressBar {
  public:
    ProgressBar(std::string title, const CommonOptions& options);
    ~ProgressBar();
    Progress callback();

  private:
    bool update(std::string_view stage, double done);
    std::string title_, shown_;
    bool on_ = false;
};

}  // namespace domelight::cli
