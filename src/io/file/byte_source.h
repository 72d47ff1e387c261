#pragma once

#include "domelight/base/large_allocator.h"
#include "domelight/base/result.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace domelight {

/// Bytes that are not cleared when allocated, because they are about to be filled.
using Bytes = std::vector<std::uint8_t, LargeAllocator<std::uint8_t>>;

/// Bytes to parse, of known number: a file or memory. Parsers read what they need and never keep more in memory.
class ByteSource {
  public:
    virtual ~ByteSource() = default;
    virtual std::uint64_t size() const = 0;
    /// Fills `out` with the bytes from `offset`. Errors: some of them do not exist, or cannot be read. `what` names
    /// them in the message.
    virtual Result<void> read(std::uint64_t offset, std::span<std::uint8_t> out, const char* what) = 0;

    /// Whether [offset, offset + count) lies inside.
    bool contains(std::uint64_t offset, std::uint64_t count) const {
        return offset <= size() && count <= size() - offset;
    }
    /// The bytes of a range; allocates only once it is known to lie inside.
    Result<Bytes> take(std::uint64_t offset, std::uint64_t count, const char* what);

  protected:
    /// The error for a range that does not lie inside.
    Error truncated(std::uint64_t offset, std::uint64_t count, const char* what) const;
};

class MemorySource : public ByteSource {
  public:
    explicit MemorySource(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    std::uint64_t size() const override { return bytes_.size(); }
    Result<void> read(std::uint64_t offset, std::span<std::uint8_t> out, const char* what) override;

  private:
    std::span<const std::uint8_t> bytes_;
};

class FileSource : public ByteSource {
  public:
    static Result<FileSource> open(const std::filesystem::path& file);
    ~FileSource() override;
    FileSource(FileSource&& other) noexcept;
    FileSource& operator=(FileSource&&) = delete;
    std::uint64_t size() const override { return size_; }
    Result<void> read(std::uint64_t offset, std::span<std::uint8_t> out, const char* what) override;

  private:
    FileSource(int descriptor, std::uint64_t size) : descriptor_(descriptor), size_(size) {}
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

/// Little-endian numbers of a header.
inline std::uint32_t u32_at(std::span<const std::uint8_t> bytes, std::size_t at) {
    return std::uint32_t(bytes[at]) | std::uint32_t(bytes[at + 1]) << 8 | std::uint32_t(bytes[at + 2]) << 16 |
           std::uint32_t(bytes[at + 3]) << 24;
}
inline std::uint64_t u64_at(std::span<const std::uint8_t> bytes, std::size_t at) {
    return u32_at(bytes, at) | std::uint64_t(u32_at(bytes, at + 4)) << 32;
}

}  // namespace domelight
