#pragma once
// The key/value data that KTX 1.1 and KTX 2.0 files begin with.

#include "io/file/byte_source.h"

#include <map>
#include <string>

namespace domelight {

/// Numbers of 32 bits in a file's endianness.
struct FileWords {
    std::span<const std::uint8_t> bytes;
    bool swapped;  ///< the file was written on a machine of the other endianness
    std::uint32_t at(std::size_t offset) const {
        const std::uint32_t v = u32_at(bytes, offset);
        return swapped ? v >> 24 | (v >> 8 & 0xff00u) | (v << 8 & 0xff0000u) | v << 24 : v;
    }
};

/// Reads `bytes` bytes of key/value data from `offset`: each pair is its size (32 bits), the key, a zero byte and the
/// value, padded to four bytes (KTX File Format Specification 1.1, section 2.12; 2.0, section 3.12). Errors: more bytes
/// than k_max_metadata_bytes, a pair that runs over the end or lacks a key, a key that is not UTF-8.
Result<void> read_key_values(ByteSource& source, std::uint64_t offset, std::uint64_t bytes, bool swapped,
                             std::map<std::string, std::string>& metadata);

}  // namespace domelight
