#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace domelight {

/// A character and the bytes that it takes. A byte that does not begin a character in UTF-8 is not valid and stands
/// alone: `code` is then the byte.
struct Utf8Character {
    std::uint32_t code = 0;
    std::size_t bytes = 1;
    bool valid = true;
};

/// The character at the start of a text of at least one byte. Forms that are not the shortest, halves of surrogate
/// pairs, and code points beyond U+10FFFF are not valid.
Utf8Character first_utf8_character(std::string_view text);

}  // namespace domelight
