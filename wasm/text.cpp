// base/text.cpp and base/read_number.cpp without std::to_chars and std::from_chars, whose tables for doubles are 150 and 11 kilobytes.

#include "base/read_number.h"
#include "base/text.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace domelight {

namespace {

/// The shortest digits that `parse` reads back as the same value, as "d.ddde+xx".
template <typename Number, typename Parse>
std::string shortest_digits(Number value, int most, const Parse& parse) {
    char text[40] = "";
    for (int digits = 0; digits < most; ++digits) {
        std::snprintf(text, sizeof text, "%.*e", digits, double(value));
        if (parse(text) == value) break;
    }
    return text;
}

/// The same number without an exponent, where it is not longer so.
std::string plain_or_scientific(const std::string& scientific) {
    const std::size_t e = scientific.find('e');
    const bool negative = scientific[0] == '-';
    std::string digits = scientific.substr(negative, e - negative);
    if (digits.size() > 1) digits.erase(1, 1);
    const int exponent = std::atoi(scientific.c_str() + e + 1), count = int(digits.size());
    if (exponent < -6 || exponent > 20) return scientific;
    std::string plain = digits;
    if (exponent < 0)
        plain = "0." + std::string(std::size_t(-exponent - 1), '0') + digits;
    else if (exponent + 1 >= count)
        plain += std::string(std::size_t(exponent + 1 - count), '0');
    else
        plain.insert(std::size_t(exponent + 1), ".");
    if (negative) plain.insert(0, "-");
    return plain.size() <= scientific.size() ? plain : scientific;
}

template <typename Number, typename Parse>
std::string shortest(Number value, int most, const Parse& parse) {
    if (std::isnan(value)) return std::signbit(value) ? "-nan" : "nan";
    if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
    return plain_or_scientific(shortest_digits(value, most, parse));
}

}  // namespace

std::string decimal(double value) {
    return shortest(value, 17, [](const char* text) { return std::strtod(text, nullptr); });
}

std::string decimal(float value) {
    return shortest(value, 9, [](const char* text) { return std::strtof(text, nullptr); });
}

std::string decimal(std::int64_t value) {
    return std::to_string(value);
}

const char* read_number(const char* begin, const char* end, double& value) {
    // strtod also takes blanks, a plus and hexadecimal digits, and wants a terminator.
    char text[64] = "";
    int count = 0;
    while (begin + count < end && count < 63 && begin[count] != 'x' && begin[count] != 'X') text[count] = begin[count], ++count;
    if (text[0] == '+' || static_cast<unsigned char>(text[0]) <= ' ') return nullptr;
    char* stopped = nullptr;
    const double number = std::strtod(text, &stopped);
    if (stopped == text || std::isinf(number)) return nullptr;
    value = number;
    return begin + (stopped - text);
}

}  // namespace domelight
