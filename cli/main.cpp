#include "domelight/base/version.h"
#include "domelight/io/file/atomic_file.h"

#include "cli/about/about.h"
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

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>
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
    {"batch", "plans any number of jobs and does them: resumable, on one machine or on a cluster", run_batch},
    {"brdf", "writes the BRDF table of the split sum alone, which is the same for every environment", run_brdf},
    {"compare", "compares two pictures, or a bake by any tool with the exact filter", run_compare},
    {"convert", "converts an environment to another projection, convention, orientation, size or format", run_convert},
    {"info", "describes an environment, a texture or a bake", run_info},
    {"probes", "captures the light at many points of a scene, and bakes each", run_probes},
    {"render", "renders a scene under an environment: by path tracing, or as an engine draws it", run_render},
    {"lights", "extracts the sun and other small bright sources as lights, and the environment without them",
     run_lights},
    {"sample", "draws light directions from an environment, and compares the errors of sampling strategies",
     run_sample},
    {"sky", "makes a physically based sky, or the labelled six-axis environment", run_sky},
    {"view", "opens a page that shows a model under an environment by every method, beside the truth", run_view},
};

constexpr const char* k_summary =
    "image-based lighting, computed exactly: bakes for real-time engines, light samples, reference renders";
constexpr std::array k_examples{"domelight bake studio.hdr -o out", "domelight info studio.hdr",
                                "domelight sky -o evening.hdr --sun-elevation-deg 4"};
constexpr std::array k_shells{"bash", "zsh", "fish"};

std::string help() {
    std::string text = "Examples:\n";
    for (const char* example : k_examples) text += fmt::format("  {}\n", example);
    std::string summary = k_summary;
    summary[0] = 'I';
    text += fmt::format("\ndomelight COMMAND ...\n{}.\n\nCommands:\n", summary);
    for (const Command& command : k_commands) text += fmt::format("  {:<28}{}\n", command.name, command.does);
    return text +
           "\ndomelight help COMMAND (or domelight COMMAND --help) lists a command's options.\n"
           "domelight completion bash|zsh|fish prints a script with which the shell completes these words.\n"
           "  --version                   the version\n"
           "  --help                      this text\n"
           "\nExit status: 0 done, 1 failed, 2 wrong usage.\n";
}

/// All that the commands say of themselves.
ProgramDescription describe_program() {
    ProgramDescription program{k_summary, {k_examples.begin(), k_examples.end()}, {}, {}};
    DescriptionCollector collector;
    for (const Command& command : k_commands) {
        program.does.emplace_back(command.name, command.does);
        command.run({"--help"});
    }
    program.commands = std::move(collector.commands);
    return program;
}

/// domelight completion SHELL.
int print_completion(const std::vector<std::string>& words) {
    const std::vector<std::string> shells(k_shells.begin(), k_shells.end());
    if (words.size() != 1 || std::ranges::find(shells, words[0]) == shells.end())
        return print_error({"names one shell: " + join(shells, ", "), "completion", "As in: domelight completion bash"},
                           exit_usage);
    print_lines(completion_script(describe_program(), words[0]));
    return exit_done;
}

/// domelight manual DIR: writes the manual pages and the completions, which cmake --install installs.
int write_manual(const std::vector<std::string>& words) {
    if (words.size() != 1) return print_error({"names one folder that exists", "manual", ""}, exit_usage);
    const std::filesystem::path folder = words[0];
    const ProgramDescription program = describe_program();
    std::vector<std::pair<std::string, std::string>> files{{"domelight.1", program_manual(program)},
                                                           {"domelight", completion_script(program, "bash")},
                                                           {"_domelight", completion_script(program, "zsh")},
                                                           {"domelight.fish", completion_script(program, "fish")}};
    for (const CommandDescription& command : program.commands)
        files.emplace_back("domelight-" + command.command + ".1", command_manual(program, command));
    for (const auto& [name, text] : files)
        if (auto ok = write_file_atomically(folder / name, text); !ok) return print_error(ok.error());
    return exit_done;
}

/// Says that a word is no command.
int refuse(const std::string& word) {
    std::vector<std::string> commands, names{"help", "completion", "--help", "--version"};
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
    const std::vector<std::string> rest(words.begin() + 1, words.end());
    if (words[0] == "completion") return print_completion(rest);
    if (words[0] == "manual") return write_manual(rest);
    const std::string& name = words[wants_help ? 1 : 0];
    for (const Command& command : k_commands)
        if (name == command.name) return command.run(wants_help ? std::vector<std::string>{"--help"} : rest);
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
        // A full disk or a closed pipe behind stdout shows only now, unless the command has told of it.
        if ((std::fflush(stdout) != 0 || std::ferror(stdout)) && status == domelight::cli::exit_done)
            return domelight::cli::print_error({"results cannot be written", "stdout", ""});
        return status;
    } catch (const std::bad_alloc&) {
        return domelight::cli::print_error({"not enough memory", "", "Ask for smaller maps, or fewer at once."});
    } catch (const std::exception& e) {
        return domelight::cli::print_error({e.what(), "", ""});
    }
}
