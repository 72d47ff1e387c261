#include "base/utf8.h"

namespace domelight {

Utf8Character first_utf8_character(std::string_view text) {
    const auto byte = [&](std::size_t i) { return std::uint32_t(std::uint8_t(text[i])); };
    const std::uint32_t lead = byte(0);
    if (lead < 0x80) return {lead, 1, true};
    const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    const Utf8Character broken{lead, 1, false};
    if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return broken;
    std::uint32_t code = lead & (0xffu >> (bytes + 1));
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return broken;
        code = code << 6 | (byte(i) & 0x3f);
    }
    // Not in the shortest form, half of a surrogate pair, beyond Unicode's end.
    constexpr std::uint32_t k_least[5] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < k_least[bytes] || (code >= 0xd800 && code <= 0xdfff) || code > 0x10ffff) return broken;
    return {code, bytes, true};
}

}  // namespace domelight
