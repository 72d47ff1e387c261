#include "domelight/base/version.h"
#include "domelight/io/file/atomic_file.h"

#include "cli/commands.h"
#include "cli/console/arguments.h"
#include "cli/console/console.h"
#include "cli/console/print.h"
#include "cli/console/suggestion.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <exception>
#include <string>
#include <vector>

namespace domelight::cli {
namespace {

struct Command {
    const char* name;
    const char* does;
    int (*run)(const std::vector<std::string>&);
};

constexpr Command k_commands[] = {
    {"bake", "bakes an environment for an engine: specular levels, irradiance, harmonics and BRDF table", run_bake},
    {"brdf", "writes the BRDF table of the split sum alone, which is the same for every environment", run_brdf},
    {"compare", "compares two pictures, or a bake by any tool with the exact filter", run_compare},
    {"convert", "converts an environment to another projection, convention, orientation, size or format", run_convert},
    {"info", "describes an environment, a texture or a bake", run_info},
    {"render", "renders a scene under an environment: by path tracing, or as an engine draws it", run_render},
    {"lights", "extracts the sun and other small bright sources as lights, and the environment without them",
     run_lights},
    {"sample", "draws light directions from an environment, and compares the errors of sampling strategies",
     run_sample},
    {"sky", "makes a physically based sky, or the labelled six-axis environment", run_sky},
    {"view", "opens a page that shows a model under an environment by every method, beside the truth", run_view},
};

std::string help() {
    std::string text =
        "Examples:\n"
        "  domelight bake studio.hdr -o out\n"
        "  domelight info studio.hdr\n"
        "  domelight sky -o evening.hdr --sun-elevation-deg 4\n"
        "\ndomelight COMMAND ...\nImage-based lighting, computed exactly: bakes for real-time engines, light samples, "
        "reference renders.\n\nCommands:\n";
    for (const Command& command : k_commands) text += fmt::format("  {:<28}{}\n", command.name, command.does);
    return text +
           "\ndomelight help COMMAND (or domelight COMMAND --help) lists a command's options.\n"
           "  --version                   the version\n"
           "  --help                      this text\n"
           "\nExit status: 0 done, 1 failed, 2 wrong usage.\n";
}

/// Says that a word is no command.
int refuse(const std::string& word) {
    std::vector<std::string> commands, names{"help", "--help", "--version"};
    for (const Command& command : k_commands) commands.emplace_back(command.name);
    names.insert(names.end(), commands.begin(), commands.end());
    return print_error(
        {fmt::format("unknown {} {}", word.starts_with("-") ? "option" : "command", word), "",
         fmt::format("{}Commands: {}. Options: --help, --version.", did_you_mean(word, names), join(commands, ", "))},
        exit_usage);
}

int run(const std::vector<std::string>& words) {
    if (words.empty()) {
        print_to_stderr(help());
        return exit_usage;
    }
    const bool wants_help = words[0] == "--help" || words[0] == "-h" || words[0] == "help";
    if (wants_help && words.size() == 1) {
        print_lines(help());
        return exit_done;
    }
    if (words[0] == "--version") {
        print("domelight {}\n", version());
        return exit_done;
    }
    const std::string& name = words[wants_help ? 1 : 0];
    for (const Command& command : k_commands)
        if (name == command.name)
            return command.run(wants_help ? std::vector<std::string>{"--help"}
                                          : std::vector<std::string>(words.begin() + 1, words.end()));
    return refuse(name);
}

/// Opens /dev/null in place of standard streams that the caller closed: otherwise the first file that is opened would
/// become one of them, and what is printed would go into it. Writing to the closed stdout stays an error.
void open_closed_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
            ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);  // the lowest number that is free
}

}  // namespace
}  // namespace domelight::cli

int main(int argc, char** argv) {
#ifdef __GLIBC__
    // Freed memory is kept for the next array: the system would clear each of its pages again.
    ::mallopt(M_MMAP_THRESHOLD, 32 << 20);
    ::mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
    domelight::cli::open_closed_streams();
    domelight::remove_temporaries_on_signals();
    try {
        const int status = domelight::cli::run({argv + 1, argv + argc});
        // A full disk or a closed pipe behind stdout shows only now.
        if (std::fflush(stdout) != 0 || std::ferror(stdout))
            return domelight::cli::print_error({"results cannot be written", "stdout", ""});
        return status;
    } catch (const std::bad_alloc&) {
        return domelight::cli::print_error({"not enough memory", "", "Ask for smaller maps, or fewer at once."});
    } catch (const std::exception& e) {
        return domelight::cli::print_error({e.what(), "", ""});
    }
}
