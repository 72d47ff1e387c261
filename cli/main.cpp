#include "domelight/io/file/atomic_file.h"
#include "domelight/bake/bake.h"

#include "cli/console/arguments.h"
#include "cli/commands.h"
#include "cli/console/console.h"

#include <fmt/core.h>

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
    {"bake", "an environment to specular levels, irradiance, harmonics and BRDF table, as an engine loads them",
     run_bake},
    {"compare", "how far two pictures are apart, or a bake of any tool from the exact filter", run_compare},
    {"convert", "an environment to another projection, convention, orientation, size or format", run_convert},
    {"info", "what an environment, a texture or a bake holds", run_info},
    {"render", "a scene under an environment: the truth by path tracing, or what an engine draws", run_render},
    {"lights", "the sun and other small bright sources as lights, and the environment without them", run_lights},
    {"sample", "light directions from an environment, pictures of them, and the error each strategy leaves",
     run_sample},
    {"sky", "a physically based sky, or the labelled six-axis environment", run_sky},
};

std::string help() {
    std::string text =
        "Examples:\n"
        "  domelight bake studio.hdr -o out\n"
        "  domelight info studio.hdr\n"
        "  domelight sky -o evening.hdr --sun-elevation-deg 4\n"
        "\ndomelight COMMAND ...\nImage-based lighting: exact, and about as fast as reading the file.\n\nCommands:\n";
    for (const Command& command : k_commands) text += fmt::format("  {:<28}{}\n", command.name, command.does);
    return text +
           "\ndomelight COMMAND --help tells of a command's options.\n"
           "  --version                   the version\n"
           "  --help                      this text\n"
           "\nExit status: 0 done, 1 failed, 2 wrong usage.\n";
}

std::string command_names() {
    std::vector<std::string> names;
    for (const Command& command : k_commands) names.emplace_back(command.name);
    return join(names, ", ");
}

int run(const std::vector<std::string>& words) {
    if (words.empty() || words[0] == "--help" || words[0] == "-h" || words[0] == "help") {
        fmt::print(words.empty() ? stderr : stdout, "{}", help());
        return words.empty() ? exit_usage : exit_done;
    }
    if (words[0] == "--version") {
        fmt::print("domelight {}\n", version());
        return exit_done;
    }
    for (const Command& command : k_commands)
        if (words[0] == command.name) return command.run({words.begin() + 1, words.end()});
    const bool option = words[0].starts_with("-");
    return print_error({fmt::format("unknown {} {}", option ? "option" : "command", words[0]), "",
                        fmt::format("Commands: {}. Options: --help, --version.", command_names())},
                       exit_usage);
}

}  // namespace
}  // namespace domelight::cli

int main(int argc, char** argv) {
    domelight::remove_temporaries_on_signals();
    try {
        const int status = domelight::cli::run({argv + 1, argv + argc});
        // A full disk or a closed pipe behind stdout shows only now.
        if (std::fflush(stdout) != 0) return domelight::cli::print_error({"results cannot be written", "stdout", ""});
        return status;
    } catch (const std::bad_alloc&) {
        return domelight::cli::print_error({"not enough memory", "", "Ask for smaller maps, or fewer at once."});
    } catch (const std::exception& e) {
        return domelight::cli::print_error({e.what(), "", ""});
    }
}
