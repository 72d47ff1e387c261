#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace domelight {

/// Bytes in zlib's format (RFC 1950). `level`, `strategy` and `window_bits` are those of zlib's deflateInit2().
std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes, int level, int strategy, int window_bits = 15);

}  // namespace domelight
