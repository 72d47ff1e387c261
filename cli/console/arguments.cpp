#include "cli/console/arguments.h"

#include "cli/console/suggestion.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

namespace domelight::cli {

namespace {

template <typename T>
Result<T> parse_whole(const std::string& text, const char* what) {
    T value{};
    const char* const end = text.data() + text.size();
    const auto [stop, code] = std::from_chars(text.data(), end, value);
    if (code != std::errc() || stop != end || text.empty())
        return Error{fmt::format("\"{}\" is not {}", text, what), "", ""};
    return value;
}

/// What a callback tells parse() through CLI11's own exception.
struct ValueError : CLI::Error {
    explicit ValueError(domelight::Error e) : CLI::Error("ValueError", e.what, 2), error(std::move(e)) {}
    domelight::Error error;
};

}  // namespace

Result<void> within(const char* option, double value, double low, double high) {
    if (value >= low && value <= high) return {};
    return Error{fmt::format("{:.12g} is not from {:.12g} to {:.12g}", value, low, high), option, ""};
}

Result<double> parse_number(const std::string& text) {
    return parse_whole<double>(text, "a number");
}
Result<int> parse_integer(const std::string& text) {
    // 1e6, as numbers of samples are often written.
    if (text.find_first_of("eE") != std::string::npos)
        if (const auto value = parse_number(text); value && *value == std::trunc(*value) && std::abs(*value) <= 1e9)
            return int(*value);
    return parse_whole<int>(text, "a whole number");
}
Result<std::uint64_t> parse_seed(const std::string& text) {
    return parse_whole<std::uint64_t>(text, "a whole number from 0 to 18446744073709551615");
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> words;
    std::size_t begin = 0;
    for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
        words.push_back(text.substr(begin, end - begin));
    words.push_back(text.substr(begin));
    return words;
}

std::string join(const std::vector<std::string>& words, const std::string& separator) {
    std::string text;
    for (const std::string& word : words) {
        if (!text.empty()) text += separator;
        text += word;
    }
    return text;
}

struct Arguments::Parser {
    CLI::App app;
    struct Entry {
        std::string group, name, value_name, help;
        CLI::Option* option = nullptr;
        std::vector<std::pair<std::string, std::string>> table = {};  ///< values and what they stand for
        std::vector<std::string> accepted = {};                       ///< the values, where they are known
    };
    std::vector<Entry> entries;
    bool help = false;

    /// An option whose every value goes through `take`.
    void add(const std::string& group, const std::string& name, const std::string& value_name,
             const std::string& help_text, std::function<Result<void>(const std::string&)> take,
             bool repeatable = false) {
        const std::string long_name = "--" + split(name.substr(name.find("--") + 2), ',')[0];
        CLI::Option* option = app.add_option(
            name,
            [take, long_name](const CLI::results_t& values) {
                for (const std::string& value : values)
                    if (auto ok = take(value); !ok) throw ValueError(ok.error().at(long_name));
                return true;
            },
            help_text);
        option->expected(1);
        option->multi_option_policy(repeatable ? CLI::MultiOptionPolicy::TakeAll : CLI::MultiOptionPolicy::TakeLast);
        option->allow_extra_args(false);
        entries.push_back({group, name, value_name, help_text, option});
    }

    /// Whether an environment is named without an option.
    bool takes_environment() const {
        return std::ranges::any_of(entries, [](const Entry& e) { return e.name == "IN" || e.name.starts_with("ENV"); });
    }

    std::vector<std::string> option_names() const {
        std::vector<std::string> names;
        for (const Entry& entry : entries)
            for (const std::string& name : split(entry.name, ','))
                if (name.starts_with("--")) names.push_back(name);
        names.push_back("--help");
        return names;
    }
};

Arguments::Arguments(std::string command, std::string summary, std::vector<std::string> examples)
    : parser_(std::make_unique<Parser>()),
      command_(std::move(command)),
      summary_(std::move(summary)),
      examples_(std::move(examples)) {
    parser_->app.set_help_flag();
    parser_->app.allow_extras(false);
}

Arguments::~Arguments() = default;

void Arguments::positional(const std::string& name, std::vector<std::string>& values, const std::string& help) {
    CLI::Option* option = parser_->app.add_option(name, values, help);
    option->expected(0, CLI::detail::expected_max_vector_size);
    parser_->entries.push_back({"", name, "", help, option});
}

void Arguments::flag(const std::string& name, bool& value, const std::string& help) {
    parser_->entries.push_back({group_, name, "", help, parser_->app.add_flag(name, value, help)});
}

void Arguments::text(const std::string& name, const std::string& value_name, std::string& value,
                     const std::string& help) {
    parser_->add(group_, name, value_name, help, [&value](const std::string& word) -> Result<void> {
        value = word;
        return {};
    });
}

void Arguments::texts(const std::string& name, const std::string& value_name, std::vector<std::string>& values,
                      const std::string& help) {
    parser_->add(
        group_, name, value_name, help,
        [&values](const std::string& word) -> Result<void> {
            values.push_back(word);
            return {};
        },
        true);
}

void Arguments::integer(const std::string& name, const std::string& value_name, std::optional<int>& value,
                        const std::string& help) {
    parser_->add(group_, name, value_name, help, [&value](const std::string& word) -> Result<void> {
        const auto number = parse_integer(word);
        if (!number) return number.error();
        value = *number;
        return {};
    });
}

void Arguments::number(const std::string& name, const std::string& value_name, double& value, const std::string& help) {
    parser_->add(group_, name, value_name, help, [&value](const std::string& word) -> Result<void> {
        const auto number = parse_number(word);
        if (!number) return number.error();
        if (std::isnan(*number) && std::isnan(value)) return Error{fmt::format("\"{}\" is not a number", word), "", ""};
        value = *number;
        return {};
    });
}

void Arguments::numbers(const std::string& name, const std::string& value_name, std::vector<double>& values,
                        const std::string& help) {
    parser_->add(group_, name, value_name, help, [&values](const std::string& list) -> Result<void> {
        values.clear();
        for (const std::string& word : split(list, ',')) {
            const auto number = parse_number(word);
            if (!number) return number.error();
            values.push_back(*number);
        }
        return {};
    });
}

namespace {

Result<void> check_choice(const std::string& word, const std::vector<std::string>& accepted) {
    if (std::find(accepted.begin(), accepted.end(), word) != accepted.end()) return {};
    return Error{fmt::format("\"{}\" is not one of its values", word), "",
                 did_you_mean(word, accepted) + "Accepted: " + join(accepted, ", ") + "."};
}

}  // namespace

void Arguments::choice_by_place(const std::string& name, const std::vector<std::string>& accepted,
                                std::function<void(std::size_t)> take, const std::string& help) {
    parser_->add(group_, name, join(accepted, "|"), help,
                 [accepted, take = std::move(take)](const std::string& word) -> Result<void> {
                     if (auto ok = check_choice(word, accepted); !ok) return ok;
                     take(std::size_t(std::find(accepted.begin(), accepted.end(), word) - accepted.begin()));
                     return {};
                 });
    parser_->entries.back().accepted = accepted;
}

void Arguments::choice(const std::string& name, std::string& value, const std::vector<std::string>& accepted,
                       const std::string& help) {
    choice_by_place(
        name, accepted, [&value, accepted](std::size_t i) { value = accepted[i]; }, help);
}

void Arguments::choices(const std::string& name, std::vector<std::string>& values,
                        const std::vector<std::string>& accepted, const std::string& help) {
    parser_->add(
        group_, name, join(accepted, "|"), help,
        [&values, accepted](const std::string& list) -> Result<void> {
            for (const std::string& word : split(list, ',')) {
                if (auto ok = check_choice(word, accepted); !ok) return ok;
                values.push_back(word);
            }
            return {};
        },
        true);
    parser_->entries.back().accepted = accepted;
}

void Arguments::choices(const std::string& name, const std::string& value_name, std::vector<std::string>& values,
                        const std::vector<std::pair<std::string, std::string>>& accepted, const std::string& help) {
    std::vector<std::string> words;
    for (const auto& [word, meaning] : accepted) words.push_back(word);
    choices(name, values, words, help);
    parser_->entries.back().value_name = value_name;
    parser_->entries.back().table = accepted;
}

bool Arguments::given(const std::string& name) const {
    for (const auto& entry : parser_->entries)
        if (entry.name.ends_with(name)) return entry.option->count() > 0;
    return false;
}

Result<void> Arguments::parse(const std::vector<std::string>& words) {
    if (std::any_of(words.begin(), words.end(), [](const auto& word) { return word == "--help" || word == "-h"; })) {
        parser_->help = true;
        return {};
    }
    const std::string see = "See domelight " + command_ + " --help.";
    try {
        parser_->app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes them from the back
    } catch (const ValueError& e) {
        return e.error;
    } catch (const CLI::ExtrasError&) {
        const auto rest = parser_->app.remaining();
        const std::string first = rest.empty() ? "" : rest.front();
        if (!first.starts_with("-")) return Error{"\"" + first + "\" is one argument too many", "", see};
        const auto names = parser_->option_names();
        const std::string name = split(first, '=')[0];
        if (name == "--env" && parser_->takes_environment())
            return Error{"unknown option --env", "",
                         "The environment stands without an option: domelight " + command_ + " ENV ..."};
        const std::string guess = did_you_mean(name, names);
        return Error{"unknown option " + first, "",
                     guess.empty() ? "Accepted: " + join(names, ", ") + "." : guess + see};
    } catch (const CLI::ArgumentMismatch&) {
        // The one that is the last word has nothing behind it; CLI11's own text does not read well.
        return Error{"needs one value", words.empty() ? "" : words.back(), see};
    } catch (const CLI::Error& e) {
        return Error{e.what(), "", see};
    }
    return {};
}

bool Arguments::help_wanted() const {
    return parser_->help;
}

namespace {

/// `text` broken at spaces into lines of at most `width`, those after the first indented.
std::string wrap(const std::string& text, std::size_t width, std::size_t indent) {
    std::string out;
    std::size_t column = 0;
    for (const std::string& word : split(text, ' ')) {
        if (column && column + 1 + word.size() > width) {
            out += "\n" + std::string(indent, ' ');
            column = 0;
        } else if (column) {
            out += ' ';
            ++column;
        }
        out += word;
        column += word.size();
    }
    return out;
}

constexpr const char* k_about_defaults =
    "What stands in parentheses at the end of an option's description is the default.";

}  // namespace

std::string Arguments::help() const {
    std::string out = "Examples:\n";
    for (const std::string& example : examples_) out += "  " + example + "\n";
    std::string usage = "domelight " + command_;
    for (const auto& entry : parser_->entries)
        if (entry.group.empty()) usage += " [" + entry.name + " ...]";
    out += "\n" + usage + " [OPTIONS]\n" + wrap(summary_, 100, 0) + "\n\n" + k_about_defaults + "\n";
    std::string group;
    for (const auto& entry : parser_->entries) {
        if (entry.group != group) {
            group = entry.group;
            out += "\n" + group + ":\n";
        }
        std::string left =
            "  " + join(split(entry.name, ','), ", ") + (entry.value_name.empty() ? "" : " " + entry.value_name);
        constexpr std::size_t column = 30;
        out += left.size() < column - 1 ? left + std::string(column - left.size(), ' ')
                                        : left + "\n" + std::string(column, ' ');
        out += wrap(entry.help, 110 - column, column) + "\n";
        std::size_t widest = 0;
        for (const auto& [value, meaning] : entry.table) widest = std::max(widest, value.size());
        const std::size_t indent = 6, meaning_column = indent + widest + 2;
        for (const auto& [value, meaning] : entry.table)
            out += std::string(indent, ' ') + value + std::string(meaning_column - indent - value.size(), ' ') +
                   wrap(meaning, 110 - meaning_column, meaning_column) + "\n";
    }
    return out + "  --help                      this text\n";
}

CommandDescription Arguments::description() const {
    CommandDescription description{command_, summary_, examples_, {}};
    for (const auto& entry : parser_->entries)
        description.options.push_back(
            {entry.group, split(entry.name, ','), entry.value_name, entry.help, entry.accepted, entry.table});
    return description;
}

}  // namespace domelight::cli
