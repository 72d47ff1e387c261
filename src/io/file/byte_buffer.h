#pragma once
// Little-endian numbers appended to a byte vector.

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace domelight {

class ByteBuffer {
  public:
    void u8(unsigned value) { bytes_.push_back(std::uint8_t(value)); }
    void u16(unsigned value) {
        u8(value & 255u);
        u8(value >> 8 & 255u);
    }
    void u32(std::uint32_t value) {
        u16(value & 0xffffu);
        u16(value >> 16);
    }
    void u64(std::uint64_t value) {
        u32(std::uint32_t(value));
        u32(std::uint32_t(value >> 32));
    }
    void text(std::string_view s) {
        for (char c : s) u8(std::uint8_t(c));
    }
    /// Zeros up to a multiple of `alignment`.
    void align(std::size_t alignment) {
        while (bytes_.size() % alignment) u8(0);
    }
    void append(std::span<const std::uint8_t> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
    /// Returns the bytes so far and empties the buffer.
    std::vector<std::uint8_t> take() { return std::exchange(bytes_, {}); }
    std::size_t size() const { return bytes_.size(); }
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }

  private:
    std::vector<std::uint8_t> bytes_;
};

}  // namespace domelight
