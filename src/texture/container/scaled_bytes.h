#pragma once
// For every container, rgbm, rgbd and rgbp are four bytes a texel; a key states their meaning.

#include "domelight/texture/texture.h"

#include <map>
#include <optional>
#include <string>

namespace domelight {

inline constexpr const char* k_encoding_key = "domelight.encoding";

constexpr bool is_scaled_bytes(Encoding encoding) {
    return encoding == Encoding::rgbm || encoding == Encoding::rgbd || encoding == Encoding::rgbp;
}

/// Adds the key where the encoding needs it.
inline void note_scaled_bytes(Encoding encoding, std::map<std::string, std::string>& metadata) {
    if (is_scaled_bytes(encoding)) metadata[k_encoding_key] = name_of(encoding);
}

/// Removes the key and returns its encoding. Empty if the key is missing or names another kind of encoding.
inline std::optional<Encoding> take_scaled_bytes(std::map<std::string, std::string>& metadata) {
    const auto found = metadata.find(k_encoding_key);
    if (found == metadata.end()) return std::nullopt;
    const auto encoding = from_name<Encoding>(found->second);
    if (!encoding || !is_scaled_bytes(*encoding)) return std::nullopt;
    metadata.erase(found);
    return *encoding;
}

}  // namespace domelight
