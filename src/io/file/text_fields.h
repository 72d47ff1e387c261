#pragma once

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

namespace domelight {

/// Words of a text, a line at a time; nothing is copied. Lines end in \n or \r\n.
class TextLines {
  public:
    explicit TextLines(std::string_view text) : rest_(text) {}
    bool next(std::string_view& line) {
        if (rest_.empty()) return false;
        const std::size_t end = rest_.find('\n');
        line = rest_.substr(0, end);
        rest_ = end == rest_.npos ? std::string_view() : rest_.substr(end + 1);
        if (line.ends_with('\r')) line.remove_suffix(1);
        ++number_;
        return true;
    }
    std::string_view rest() const { return rest_; }
    int number() const { return number_; }

  private:
    std::string_view rest_;
    int number_ = 0;
};

inline bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

inline std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

/// Removes the first word from `text` and returns it; empty if there is none.
inline std::string_view take_word(std::string_view& text) {
    std::size_t begin = 0;
    while (begin < text.size() && is_blank(text[begin])) ++begin;
    std::size_t end = begin;
    while (end < text.size() && !is_blank(text[end])) ++end;
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

/// The number in a word, "nan" and "inf" too; a number above the largest float is infinity.
inline bool parse_number(std::string_view word, double& value) {
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
    if (parsed.ec == std::errc::result_out_of_range) value = std::numeric_limits<double>::infinity();
    return parsed.ec != std::errc::invalid_argument && parsed.ptr == word.data() + word.size();
}

/// A double as float, without undefined behaviour for numbers that do not fit.
inline float float_of(double value) {
    if (std::abs(value) <= std::numeric_limits<float>::max() || std::isnan(value)) return float(value);
    return value < 0 ? -std::numeric_limits<float>::infinity() : std::numeric_limits<float>::infinity();
}

}  // namespace domelight
