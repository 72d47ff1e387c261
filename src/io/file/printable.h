#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace domelight {

/// Text from outside (names and comments in files, paths, arguments) in the form in which it may reach a terminal or
/// stand in a message: on one line, without anything that a terminal acts on or that changes the order of what stands
/// around it. Escaped as in C are control characters (\n, \x1b, \u009b), marks of the direction of writing, invisible
/// and line-separating characters (\u202e), and bytes that are not UTF-8 (\xff). All other characters stay as they are.
std::string escaped(std::string_view text);

/// The same of the first `longest` characters, for names within a message.
std::string printable(std::string_view text, std::size_t longest = 40);

/// A JSON document in which the characters that escaped() escapes are written as \uXXXX: it means the same. Control
/// characters below 32 between its values, line ends, stay.
std::string escaped_json(std::string_view document);

}  // namespace domelight
