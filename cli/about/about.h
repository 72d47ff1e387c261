#pragma once
// Texts about the program as a whole, made of the descriptions of its commands.

#include "cli/console/description.h"

#include <string>
#include <utility>
#include <vector>

namespace domelight::cli {

struct ProgramDescription {
    std::string summary;
    std::vector<std::string> examples;
    std::vector<std::pair<std::string, std::string>> does;  ///< each command's name, and what it does in one line
    std::vector<CommandDescription> commands;               ///< in the same order
};

/// A script that completes the program's words in a shell: "bash", "zsh" or "fish". Precondition: one of these.
std::string completion_script(const ProgramDescription& program, const std::string& shell);

/// domelight(1) as a manual page in the language of man(7).
std::string program_manual(const ProgramDescription& program);
/// domelight-COMMAND(1).
std::string command_manual(const ProgramDescription& program, const CommandDescription& command);

}  // namespace domelight::cli
