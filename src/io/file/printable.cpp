#include "io/file/printable.h"

#include "base/utf8.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace domelight {

namespace {

/// Control characters, and those that are invisible, separate lines or set the direction of writing (Unicode's
/// categories Cc, Zl, Zp and most of Cf; joiners inside words, U+200C and U+200D, are letters' business and stay).
bool acts_on_terminals(std::uint32_t code) {
    constexpr std::uint32_t k_ranges[][2] = {{0, 0x1f},        {0x7f, 0x9f},     {0xad, 0xad},     {0x61c, 0x61c},
                                             {0x180e, 0x180e}, {0x200b, 0x200b}, {0x200e, 0x200f}, {0x2028, 0x202e},
                                             {0x2060, 0x206f}, {0xfeff, 0xfeff}, {0xfff9, 0xfffb}, {0xe0000, 0xe007f}};
    return std::any_of(std::begin(k_ranges), std::end(k_ranges),
                       [&](const auto& range) { return code >= range[0] && code <= range[1]; });
}

std::string escape(const Utf8Character& c) {
    if (!c.valid || (c.code < 0x80 && c.code != '\n' && c.code != '\r' && c.code != '\t'))
        return fmt::format("\\x{:02x}", c.code);
    if (c.code < 0x80) return c.code == '\n' ? "\\n" : c.code == '\r' ? "\\r" : "\\t";
    return c.code > 0xffff ? fmt::format("\\U{:08x}", c.code) : fmt::format("\\u{:04x}", c.code);
}

std::string escape_in_json(std::uint32_t code) {
    if (code <= 0xffff) return fmt::format("\\u{:04x}", code);
    return fmt::format("\\u{:04x}\\u{:04x}", 0xd800 + ((code - 0x10000) >> 10), 0xdc00 + (code & 0x3ff));
}

}  // namespace

std::string printable(std::string_view text, std::size_t longest) {
    std::string result;
    for (std::size_t at = 0, count = 0; at < text.size() && count < longest; ++count) {
        const Utf8Character c = first_utf8_character(text.substr(at));
        if (c.valid && !acts_on_terminals(c.code))
            result += text.substr(at, c.bytes);
        else
            result += escape(c);
        at += c.bytes;
    }
    return result;
}

std::string escaped(std::string_view text) {
    return printable(text, text.size());
}

std::string escaped_json(std::string_view document) {
    std::string result;
    for (std::size_t at = 0; at < document.size();) {
        const Utf8Character c = first_utf8_character(document.substr(at));
        if (c.code >= 0x7f && c.valid && acts_on_terminals(c.code))
            result += escape_in_json(c.code);
        else
            result += document.substr(at, c.bytes);
        at += c.bytes;
    }
    return result;
}

}  // namespace domelight
