#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
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

/// Words or a number in a text. It refers to the words.
class TextPart {
  public:
    template <typename Words>
    requires std::convertible_to<const Words&, std::string_view> TextPart(const Words& words)
        : kind_(Kind::words), words_(words) {}
    TextPart(double value) : kind_(Kind::number), number_(value) {}
    TextPart(float value) : kind_(Kind::single), number_(double(value)) {}
    TextPart(std::signed_integral auto value) : kind_(Kind::whole), whole_(value) {}

    void append_to(std::string& text) const;

  private:
    enum class Kind { words, number, single, whole };
    Kind kind_;
    union {
        std::string_view words_;
        double number_;
        std::int64_t whole_;
    };
};

std::string join_text(std::initializer_list<TextPart> parts);

/// Words and numbers, one after the other: text("texel (", x, ", ", y, ")").
template <typename... Parts>
std::string text(const Parts&... parts) {
    return join_text({TextPart(parts)...});
}

}  // namespace domelight
