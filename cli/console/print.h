#pragma once
// The only way to stdout and stderr for what a command says: whatever comes from outside is escaped here.

#include "io/file/json.h"
#include "io/file/printable.h"

#include <fmt/core.h>

#include <cstdio>
#include <string_view>
#include <type_traits>
#include <utility>

namespace domelight::cli {

/// An argument as it is printed: a text escaped(), anything else as it is.
template <typename T>
decltype(auto) printed(const T& value) {
    if constexpr (std::is_convertible_v<const T&, std::string_view>)
        return escaped(value);
    else
        return (value);
}

/// Prints to stdout as fmt::print does, but every text among the arguments is escaped: a name in a file cannot begin a
/// line of its own, colour the terminal or turn the writing round. The format is the program's own and may have lines.
template <typename... Arguments>
void print(fmt::format_string<decltype(printed(std::declval<const Arguments&>()))...> format,
           const Arguments&... arguments) {
    const auto put = [&](const auto&... shown) {
        fmt::vprint(fmt::string_view(format), fmt::make_format_args(shown...));
    };
    put(printed(arguments)...);
}

/// Prints a text of several lines in which what comes from outside is escaped already.
void print_lines(std::string_view text);

/// Prints the same to stderr. A stderr that cannot be written to (closed, a full disk) changes nothing else: there is
/// nowhere to tell of it.
void print_to_stderr(std::string_view text) noexcept;

/// Prints the document that --json asks for.
void print_document(const Json& json);

}  // namespace domelight::cli
