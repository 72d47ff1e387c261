#pragma once

#include "domelight/base/names.h"
#include "domelight/base/result.h"

#include "cli/console/description.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace domelight::cli {

/// A command's options, declared one by one, then read from the command line. What is declared is also what the help
/// and the errors list.
///
/// Wraps CLI11, whose headers stay in arguments.cpp.
class Arguments {
  public:
    /// Examples are whole command lines; the help opens with them and the tests run them.
    Arguments(std::string command, std::string summary, std::vector<std::string> examples);
    ~Arguments();

    void positional(const std::string& name, std::vector<std::string>& values, const std::string& help);
    void flag(const std::string& name, bool& value, const std::string& help);
    void text(const std::string& name, const std::string& value_name, std::string& value, const std::string& help);
    void texts(const std::string& name, const std::string& value_name, std::vector<std::string>& values,
               const std::string& help);
    void integer(const std::string& name, const std::string& value_name, std::optional<int>& value,
                 const std::string& help);
    /// Where `value` is NaN before, which stands for an option that was not given, NaN is refused. What else is in
    /// range, a command checks itself.
    void number(const std::string& name, const std::string& value_name, double& value, const std::string& help);
    void numbers(const std::string& name, const std::string& value_name, std::vector<double>& values,
                 const std::string& help);
    void choice(const std::string& name, std::string& value, const std::vector<std::string>& accepted,
                const std::string& help);
    /// The name of one of `accepted`. Where the option is not given, `value` stays as it is.
    template <typename T, typename V>
    void choice(const std::string& name, T& value, const std::vector<NamedValue<V>>& accepted,
                const std::string& help) {
        std::vector<std::string> words;
        for (const NamedValue<V>& a : accepted) words.emplace_back(a.name);
        choice_by_place(
            name, words, [&value, accepted](std::size_t i) { value = accepted[i].value; }, help);
    }
    /// The name of any value of an enumeration.
    template <NamedEnum E>
    void choice(const std::string& name, E& value, const std::string& help) {
        choice(name, value, std::vector(std::begin(EnumNames<E>::table), std::end(EnumNames<E>::table)), help);
    }
    template <NamedEnum E>
    void choice(const std::string& name, std::optional<E>& value, const std::string& help) {
        choice(name, value, std::vector(std::begin(EnumNames<E>::table), std::end(EnumNames<E>::table)), help);
    }
    /// Several of `accepted`, in several options or separated by commas.
    void choices(const std::string& name, std::vector<std::string>& values, const std::vector<std::string>& accepted,
                 const std::string& help);
    /// The same, where the help has one line for each accepted value: its name, and what it stands for.
    void choices(const std::string& name, const std::string& value_name, std::vector<std::string>& values,
                 const std::vector<std::pair<std::string, std::string>>& accepted, const std::string& help);
    /// A heading for the options declared after it.
    void group(const std::string& heading) { group_ = heading; }
    /// Whether the option was given.
    bool given(const std::string& name) const;

    /// Errors are the user's: an unknown option, a value that is not accepted (the hint lists what is), a missing
    /// value. `--help` sets help_wanted() and is no error.
    Result<void> parse(const std::vector<std::string>& words);
    bool help_wanted() const;
    std::string help() const;
    CommandDescription description() const;

  private:
    /// `take` gets the place of the given word in `accepted`.
    void choice_by_place(const std::string& name, const std::vector<std::string>& accepted,
                         std::function<void(std::size_t)> take, const std::string& help);

    struct Parser;
    std::unique_ptr<Parser> parser_;
    std::string command_, summary_, group_ = "Options";
    std::vector<std::string> examples_;
};

/// A decimal number without anything after it; "inf" and "nan" are some.
Result<double> parse_number(const std::string& text);
Result<int> parse_integer(const std::string& text);
/// Any 64-bit number.
Result<std::uint64_t> parse_seed(const std::string& text);
/// An error at `option` unless the value is from `low` to `high`.
Result<void> within(const char* option, double value, double low, double high);
std::vector<std::string> split(const std::string& text, char separator);
std::string join(const std::vector<std::string>& words, const std::string& separator);

}  // namespace domelight::cli
