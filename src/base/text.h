#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace domelight {

/// What the rooms below the files need for their errors, without a library of formatting.

/// A number in decimal: the shortest digits that read back as the same value; "inf", "-inf" or "nan" if it is none.
std::string decimal(double value);
std::string decimal(float value);
std::string decimal(std::int64_t value);
inline std::string decimal(int value) {
    return decimal(std::int64_t(value));
}

inline std::string as_text(std::string_view words) {
    return std::string(words);
}
template <typename Number>
requires requires(Number n) {
    decimal(n);
}
std::string as_text(Number number) {
    return decimal(number);
}

/// Words and numbers, one after the other: text("texel (", x, ", ", y, ")").
template <typename... Parts>
std::string text(const Parts&... parts) {
    std::string result;
    (result.append(as_text(parts)), ...);
    return result;
}

}  // namespace domelight
