#include "scene/gltf/gltf_uri.h"

#include "io/file/path_inside.h"
#include "io/file/printable.h"

#include <algorithm>
#include <array>

namespace domelight {

namespace {

constexpr std::array<std::int8_t, 256> k_base64 = [] {
    std::array<std::int8_t, 256> table{};
    table.fill(-1);
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < alphabet.size(); ++i) table[std::uint8_t(alphabet[i])] = std::int8_t(i);
    return table;
}();

int hex(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/// "%20" to " ". What is no such escape stays as it is.
std::string percent_decoded(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape = text[i] == '%' && i + 2 < text.size() && hex(text[i + 1]) >= 0 && hex(text[i + 2]) >= 0;
        out += escape ? char(hex(text[i + 1]) * 16 + hex(text[i + 2])) : text[i];
        if (escape) i += 2;
    }
    return out;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

Result<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == uri.npos || !uri.substr(0, comma).ends_with(";base64"))
        return Error{"a data URI that is not base64", "", ""};
    std::string_view text = uri.substr(comma + 1);
    while (text.ends_with('=')) text.remove_suffix(1);
    std::vector<std::uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const int digit = k_base64[std::uint8_t(c)];
        if (digit < 0) return Error{"a data URI with characters that are not base64", "", ""};
        bits = bits << 6 | std::uint32_t(digit);
        held += 6;
        if (held >= 8) {
            held -= 8;
            bytes.push_back(std::uint8_t(bits >> held));
        }
    }
    return bytes;
}

Result<std::filesystem::path> path_of_uri(std::string_view uri, const std::filesystem::path& folder) {
    const std::string name = percent_decoded(uri);
    const std::string shown = printable(uri, 80);
    const std::filesystem::path relative(name);
    const bool scheme = uri.substr(0, uri.find('/')).find(':') != uri.npos;
    if (name.empty() || scheme || relative.is_absolute() || name.find('\0') != name.npos)
        return Error{shown + ": not the name of a file in the folder", "", "Only files beside the scene are read."};
    return path_inside(folder / relative, folder, uri);
}

}  // namespace domelight
