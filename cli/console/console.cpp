#include "cli/console/console.h"

#include "cli/console/field_options.h"
#include "cli/console/print.h"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace domelight::cli {

void add_common_options(Arguments& arguments, CommonOptions& options) {
    arguments.group("Running");
    arguments.integer("--threads", "N", options.threads,
                      "threads to use, 0 for all; the bytes of the results do not depend on it (0)");
    arguments.flag("--json", options.json, "print one JSON document to stdout instead of text");
    arguments.flag("--quiet", options.quiet, "no progress, no warnings, no summary");
}

Result<void> check_common_options(const CommonOptions& options) {
    if (options.threads && (*options.threads < 0 || *options.threads > 1024))
        return Error{fmt::format("{} is not from 0 to 1024", *options.threads), "--threads", ""};
    return {};
}

int print_error(const Error& error, int otherwise) {
    const Error told = with_options(error);
    const Error shown{escaped(told.what), escaped(told.where), escaped(told.hint)};
    print_to_stderr(fmt::format("error: {}\n", shown.format()));
    return told.where.starts_with("--") ? exit_usage : otherwise;
}

std::optional<int> begin_command(Arguments& arguments, const std::vector<std::string>& words,
                                 const CommonOptions& options) {
    if (auto ok = arguments.parse(words); !ok) return print_error(ok.error(), exit_usage);
    if (arguments.help_wanted()) {
        if (DescriptionCollector* collector = DescriptionCollector::current()) {
            collector->commands.push_back(arguments.description());
            return exit_done;
        }
        print_lines(arguments.help());
        return exit_done;
    }
    if (auto ok = check_common_options(options); !ok) return print_error(ok.error(), exit_usage);
    return std::nullopt;
}

void print_warnings(const std::vector<std::string>& warnings, const CommonOptions& options, const std::string& place) {
    if (options.quiet) return;
    for (const std::string& warning : warnings)
        print_to_stderr(fmt::format("warning: {}{}{}\n", escaped(place), place.empty() ? "" : ": ",
                                    escaped(with_options(warning))));
}

void warn_of_idle_options(const Arguments& arguments, const std::vector<OptionRule>& rules,
                          const CommonOptions& options) {
    for (const OptionRule& rule : rules)
        if (!rule.works && arguments.given(rule.option))
            print_warnings({fmt::format("{} has no effect here: it goes with {}", rule.option, rule.with)}, options);
}

std::string clock_text(double seconds) {
    const auto s = std::int64_t(std::clamp(seconds, 0.0, 1e9) + 0.5);
    if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
    return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

ProgressBar::ProgressBar(std::string title, const CommonOptions& options)
    : title_(escaped(title)),
      start_(std::chrono::steady_clock::now()),
      on_(!options.quiet && !options.json && isatty(STDERR_FILENO)) {}

ProgressBar::~ProgressBar() {
    if (!shown_.empty()) print_to_stderr("\r\033[K");
}

Progress ProgressBar::callback() {
    if (!on_) return {};
    return [this](std::string_view stage, double done) { return update(stage, done); };
}

bool ProgressBar::update(std::string_view stage, double done) {
    using Seconds = std::chrono::duration<double>;
    const auto now = std::chrono::steady_clock::now();
    // At most ten times a second, because drawing on the terminal takes time.
    if (!on_ || (stage == stage_ && done < 1 && Seconds(now - drawn_).count() < 0.1)) return true;
    if (stage != stage_) start_ = now;
    stage_ = stage;
    drawn_ = now;
    const int full = int(std::clamp(done, 0.0, 1.0) * 24);
    std::string line = fmt::format("{}  {:<8} [{}{}] {:3.0f} %", title_, escaped(stage), std::string(full, '#'),
                                   std::string(24 - full, '.'), 100 * done);
    if (!detail_.empty()) line += "  " + detail_;
    // Estimated from what has been done so far; earlier the estimate would be unstable.
    const double spent = Seconds(now - start_).count();
    if (spent > 1 && done > 0.01 && done < 1) line += fmt::format("  {} left", clock_text(spent / done * (1 - done)));
    // A line that wraps could not be taken back.
    if (winsize window{}; ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1)
        line = printable(line, std::size_t(window.ws_col) - 1);
    if (line == shown_) return true;
    shown_ = line;
    print_to_stderr(fmt::format("\r{}\033[K", line));
    return true;
}

}  // namespace domelight::cli
