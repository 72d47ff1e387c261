#pragma once
// What a command has declared, for texts that are made of it: help, manual pages, completions of shells.

#include <string>
#include <utility>
#include <vector>

namespace domelight::cli {

struct OptionDescription {
    std::string group;               ///< its heading; empty for what stands without an option
    std::vector<std::string> names;  ///< "-o", "--output"; of what stands without an option: "ENV"
    std::string value_name;          ///< "FILE", "cube|latlong"; empty for a flag
    std::string help;
    std::vector<std::string> accepted;                       ///< its values, where they are known
    std::vector<std::pair<std::string, std::string>> table;  ///< values and what they stand for
    bool takes_value() const { return !value_name.empty() && !group.empty(); }
};

struct CommandDescription {
    std::string command, summary;
    std::vector<std::string> examples;
    std::vector<OptionDescription> options;
};

/// While one exists, commands that are asked for their help add their description to it in place of printing. One at a
/// time.
class DescriptionCollector {
  public:
    DescriptionCollector();
    ~DescriptionCollector();
    DescriptionCollector(const DescriptionCollector&) = delete;
    DescriptionCollector& operator=(const DescriptionCollector&) = delete;
    /// The one that exists, or null.
    static DescriptionCollector* current();

    std::vector<CommandDescription> commands;
};

}  // namespace domelight::cli
