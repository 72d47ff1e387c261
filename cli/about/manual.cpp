// Manual pages in the language of man(7).
#include "domelight/base/version.h"

#include "cli/about/about.h"
#include "cli/console/arguments.h"

#include <fmt/core.h>

namespace domelight::cli {
namespace {

/// Text as roff reads it: no letter of it is a command.
std::string roff(const std::string& text) {
    std::string out;
    for (const char letter : text) {
        const bool starts_line = out.empty() || out.back() == '\n';
        if (starts_line && (letter == '.' || letter == '\'')) out += "\\&";
        if (letter == '\\')
            out += "\\e";
        else if (letter == '-')
            out += "\\-";
        else
            out += letter;
    }
    return out;
}

/// Choices between bars, with a place after each bar where a line may end.
std::string choices(const std::vector<std::string>& words) {
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : "|\\:") + roff(word);
    return out;
}

std::string bold(const std::string& text) {
    return "\\fB" + roff(text) + "\\fR";
}

std::string italic(const std::string& text) {
    return "\\fI" + roff(text) + "\\fR";
}

std::string capital(std::string text) {
    if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = char(text[0] - 'a' + 'A');
    return text;
}

std::string header(const std::string& name, const std::string& does) {
    std::string title = name;
    for (char& letter : title) letter = letter >= 'a' && letter <= 'z' ? char(letter - 'a' + 'A') : letter;
    return fmt::format(".TH {} 1 \"\" \"Domelight {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", roff(title),
                       version(), roff(name), roff(does));
}

std::string examples(const std::vector<std::string>& lines) {
    std::string text = ".SH EXAMPLES\n.nf\n";
    for (const std::string& line : lines) text += roff(line) + "\n";
    return text + ".fi\n";
}

std::string option(const OptionDescription& o) {
    std::string left;
    for (const std::string& name : o.names) left += (left.empty() ? "" : ", ") + bold(name);
    if (o.takes_value())
        left += " " + (o.accepted.empty() || !o.table.empty() ? italic(o.value_name) : choices(o.accepted));
    std::string text = ".TP\n" + left + "\n" + roff(o.help) + "\n";
    if (o.table.empty()) return text;
    text += ".RS\n";
    for (const auto& [value, meaning] : o.table) text += ".TP\n" + bold(value) + "\n" + roff(meaning) + "\n";
    return text + ".RE\n";
}

constexpr const char* k_status = ".SH EXIT STATUS\n0 done, 1 failed, 2 wrong usage.\n";

}  // namespace

std::string program_manual(const ProgramDescription& program) {
    std::string text = header("domelight", program.summary);
    text += ".SH SYNOPSIS\n" + bold("domelight") + " " + italic("COMMAND") + " ...\n.SH COMMANDS\n";
    for (const auto& [name, does] : program.does) text += ".TP\n" + bold(name) + "\n" + roff(capital(does)) + ".\n";
    text += ".SH OPTIONS\n.TP\n" + bold("--version") + "\nThe version.\n.TP\n" + bold("--help") +
            "\nA list of the commands.\n";
    text += examples(program.examples) + k_status + ".SH SEE ALSO\n";
    for (std::size_t i = 0; i < program.does.size(); ++i)
        text += ".BR domelight\\-" + program.does[i].first + " (1)" + (i + 1 < program.does.size() ? ",\n" : "\n");
    return text;
}

std::string command_manual(const ProgramDescription& program, const CommandDescription& command) {
    const std::string name = "domelight-" + command.command;
    std::string does;
    for (const auto& [word, line] : program.does)
        if (word == command.command) does = line;
    std::string text = header(name, does) + ".SH SYNOPSIS\n" + bold("domelight " + command.command);
    for (const OptionDescription& o : command.options)
        if (o.group.empty()) text += " [" + italic(o.names[0]) + " ...]";
    text += " [" + italic("OPTIONS") + "]\n.SH DESCRIPTION\n" + roff(command.summary) +
            "\n.PP\nWhat stands in parentheses at the end of an option's description is the default.\n";
    std::string group;
    for (const OptionDescription& o : command.options) {
        if (o.group != group) text += ".SH " + roff(o.group) + "\n";
        group = o.group;
        text += option(o);
    }
    text += ".TP\n" + bold("--help") + "\nThis text.\n";
    return text + examples(command.examples) + k_status + ".SH SEE ALSO\n.BR domelight (1)\n";
}

}  // namespace domelight::cli
