#pragma once

namespace domelight {

/// Reads the number, by the rules of std::from_chars, at the start of a text. Returns where it ends; null: there is none, or
/// it is none that a double can hold.
const char* read_number(const char* begin, const char* end, double& value);

}  // namespace domelight
