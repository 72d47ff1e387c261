#pragma once

#include "domelight/base/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace domelight {

/// The bytes of a whole file, mapped into memory where that is possible, so that a reader touches only what it decodes.
class FileBytes {
  public:
    /// Errors: missing, not readable, empty, a folder; something that cannot be mapped (a pipe) and is over
    /// `max_bytes`.
    static Result<std::shared_ptr<const FileBytes>> open(const std::filesystem::path& file, std::int64_t max_bytes);
    static std::shared_ptr<const FileBytes> from_memory(std::vector<std::uint8_t> bytes);
    ~FileBytes();
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    std::span<const std::uint8_t> bytes() const { return {data_, size_}; }

    /// Says that bytes first .. end - 1 are not needed for now: their pages leave this process (they would count as its
    /// memory otherwise) and come back from the system's cache when they are touched again. Offsets are rounded down to
    /// a multiple of k_release_step; returns `end` so rounded, from where the next call may go on.
    std::size_t release(std::size_t first, std::size_t end) const;
    /// Large enough for releases to cost nothing, small enough for little to be held.
    static constexpr std::size_t k_release_step = std::size_t(8) << 20;

  private:
    FileBytes() = default;
    const std::uint8_t* data_ = nullptr;
    std::size_t size_ = 0;
    void* mapping_ = nullptr;  // null: the bytes are in memory_
    std::vector<std::uint8_t> memory_;
};

}  // namespace domelight
