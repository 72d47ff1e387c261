// Scripts with which shells complete the program's words.
#include "domelight/base/version.h"

#include "cli/about/about.h"
#include "cli/console/arguments.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace domelight::cli {
namespace {

/// Whether a value is the name of a file or a folder.
bool names_file(const OptionDescription& o) {
    constexpr std::array names{"FILE", "DIR", "OUT", "IN", "ENV", "SRC", "SCENE", "A", "B"};
    return o.accepted.empty() && std::ranges::find(names, o.value_name) != names.end();
}

/// In single quotes, as all three shells read it (but for fish's backslash).
std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char letter : text) out += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    return out + "'";
}

std::string words_of_commands(const ProgramDescription& program) {
    std::vector<std::string> names;
    for (const auto& [name, does] : program.does) names.push_back(name);
    return join(names, " ");
}

/// The first sentence of a help text, for lists that have a line for each option.
std::string brief(const std::string& help) {
    return help.substr(0, std::min(help.find(';'), help.find(" (")));
}

std::string bash(const ProgramDescription& program) {
    std::string values, options;
    for (const CommandDescription& command : program.commands) {
        std::vector<std::string> names;
        for (const OptionDescription& o : command.options) {
            if (o.group.empty()) continue;
            names.insert(names.end(), o.names.begin(), o.names.end());
            if (!o.takes_value()) continue;
            std::vector<std::string> patterns;
            for (const std::string& name : o.names) patterns.push_back(command.command + ":" + name);
            const std::string reply = !o.accepted.empty() ? "words=" + quoted(join(o.accepted, " "))
                                      : names_file(o)     ? "return"
                                                          : "compopt +o default; return";
            values += "        " + join(patterns, " | ") + ") " + reply + " ;;\n";
        }
        options += fmt::format("        {}) options='{} --help' ;;\n", command.command, join(names, " "));
    }
    return fmt::format(
        "# Completion of domelight {} in bash. Made by: domelight completion bash\n"
        "_domelight() {{\n"
        "    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command=${{COMP_WORDS[1]}} "
        "words= options=\n"
        "    COMPREPLY=()\n"
        "    if [ \"$COMP_CWORD\" = 1 ]; then\n"
        "        COMPREPLY=($(compgen -W '{} help completion --help --version' -- \"$word\"))\n"
        "        return\n"
        "    fi\n"
        "    # --option=word: bash splits at the equals sign.\n"
        "    if [ \"$word\" = = ]; then word=; elif [ \"$before\" = = ]; then before=${{COMP_WORDS[COMP_CWORD-2]}}; "
        "fi\n"
        "    case $command:$before in\n"
        "        help:*) words='{}' ;;\n"
        "        completion:*) words='bash zsh fish' ;;\n"
        "{}"
        "    esac\n"
        "    if [ -n \"$words\" ]; then\n"
        "        COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
        "        return\n"
        "    fi\n"
        "    [[ $word == -* ]] || return\n"
        "    case $command in\n"
        "{}"
        "    esac\n"
        "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
        "}}\n"
        "complete -o default -F _domelight domelight\n",
        version(), words_of_commands(program), words_of_commands(program), values, options);
}

/// A text inside the brackets of zsh's _arguments.
std::string zsh_text(const std::string& text) {
    std::string out;
    for (const char letter : text) {
        if (letter == '[' || letter == ']' || letter == ':' || letter == '\\') out += '\\';
        out += letter;
    }
    return out;
}

std::string zsh_option(const OptionDescription& o) {
    std::string value;
    if (o.takes_value()) {
        value = ":" + zsh_text(o.accepted.empty() ? o.value_name : "value") + ":";
        if (!o.accepted.empty())
            value += "(" + join(o.accepted, " ") + ")";
        else if (names_file(o))
            value += "_files";
    }
    std::string text;
    for (const std::string& name : o.names)
        text += " \\\n                " + quoted(fmt::format("*{}[{}]{}", name, zsh_text(brief(o.help)), value));
    return text;
}

std::string zsh(const ProgramDescription& program) {
    std::string commands, cases;
    for (const auto& [name, does] : program.does) commands += "        " + quoted(name + ":" + zsh_text(does)) + "\n";
    for (const CommandDescription& command : program.commands) {
        cases += fmt::format("        {})\n            _arguments", command.command);
        for (const OptionDescription& o : command.options)
            if (!o.group.empty()) cases += zsh_option(o);
        cases += " \\\n                '--help[this text]' '*:file:_files' ;;\n";
    }
    return fmt::format(
        "#compdef domelight\n"
        "# Completion of domelight {} in zsh. Made by: domelight completion zsh\n"
        "_domelight() {{\n"
        "    local -a commands\n"
        "    commands=(\n{}        'help:lists the options of a command'\n        'completion:prints a script for a "
        "shell'\n    )\n"
        "    if (( CURRENT == 2 )); then\n"
        "        _describe command commands\n"
        "        return\n"
        "    fi\n"
        "    shift words\n"
        "    (( CURRENT-- ))\n"
        "    case $words[1] in\n"
        "        help) _describe command commands ;;\n"
        "        completion) _values shell bash zsh fish ;;\n"
        "{}"
        "    esac\n"
        "}}\n"
        "if [ \"$funcstack[1]\" = _domelight ]; then _domelight \"$@\"; else compdef _domelight domelight; fi\n",
        version(), commands, cases);
}

/// fish also reads a backslash inside single quotes.
std::string fish_quoted(const std::string& text) {
    std::string out = "'";
    for (const char letter : text) {
        if (letter == '\'' || letter == '\\') out += '\\';
        out += letter;
    }
    return out + "'";
}

/// The values of an option for fish's complete -a, each with what it stands for.
std::string fish_values(const OptionDescription& o) {
    std::string text;
    for (const std::string& value : o.accepted) {
        std::string meaning;
        for (const auto& [word, stands_for] : o.table)
            if (word == value) meaning = stands_for;
        text += (text.empty() ? "" : " ") + value + "\\t" + fish_quoted(meaning);
    }
    return fish_quoted(text);
}

std::string fish(const ProgramDescription& program) {
    const std::string begin = "complete -c domelight", first = " -n __fish_use_subcommand -f -a ";
    std::string text =
        fmt::format("# Completion of domelight {} in fish. Made by: domelight completion fish\n", version());
    for (const auto& [name, does] : program.does) text += begin + first + name + " -d " + fish_quoted(does) + "\n";
    text += begin + first + "help -d 'lists the options of a command'\n" + begin + first +
            "completion -d 'prints a script for a shell'\n" + begin +
            " -n '__fish_seen_subcommand_from completion' -f -a 'bash zsh fish'\n" + begin +
            " -n '__fish_seen_subcommand_from help' -f -a '" + words_of_commands(program) + "'\n";
    for (const CommandDescription& command : program.commands)
        for (const OptionDescription& o : command.options) {
            if (o.group.empty()) continue;
            text += begin + " -n '__fish_seen_subcommand_from " + command.command + "'";
            for (const std::string& name : o.names)
                text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
            if (!o.accepted.empty())
                text += " -x -a " + fish_values(o);
            else if (o.takes_value())
                text += names_file(o) ? " -r" : " -x";
            text += " -d " + fish_quoted(brief(o.help)) + "\n";
        }
    return text;
}

}  // namespace

std::string completion_script(const ProgramDescription& program, const std::string& shell) {
    return shell == "bash" ? bash(program) : shell == "zsh" ? zsh(program) : fish(program);
}

}  // namespace domelight::cli
