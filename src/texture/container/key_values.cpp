#include "texture/container/key_values.h"

#include "texture/container/texture_reading.h"

#include <algorithm>

namespace domelight {

Result<void> read_key_values(ByteSource& source, std::uint64_t offset, std::uint64_t bytes, bool swapped,
                             std::map<std::string, std::string>& metadata) {
    if (bytes > k_max_metadata_bytes)
        return Error{"has " + std::to_string(bytes) + " bytes of key/value data", "", "the file is damaged"};
    const auto data = source.take(offset, bytes, "key/value data");
    if (!data) return data.error();
    const FileWords words{*data, swapped};
    const Error damaged{"has key/value data that runs over its end or lacks a key", "", "the file is damaged"};
    for (std::size_t at = 0; at < data->size();) {
        if (data->size() - at < 4) return damaged;
        const std::size_t size = words.at(at);
        at += 4;
        if (size > data->size() - at) return damaged;
        const auto pair = std::span(*data).subspan(at, size);
        const auto terminator = std::find(pair.begin(), pair.end(), std::uint8_t(0));
        if (terminator == pair.end() || terminator == pair.begin()) return damaged;
        const auto key = pair.first(std::size_t(terminator - pair.begin()));
        if (!is_utf8_text(key)) return Error{"has a key that is not UTF-8", "", "the file is damaged"};
        metadata.emplace(std::string(key.begin(), key.end()), metadata_text(pair.subspan(key.size() + 1)));
        at = std::min(data->size(), (at + size + 3) / 4 * 4);
    }
    return {};
}

}  // namespace domelight
