#pragma once

#include "domelight/base/large_allocator.h"
#include "domelight/base/result.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace domelight {

/// The largest file that is read, in bytes. (OpenEXR's 32768 x 16384 texels of 32-bit floats are 6.4e9.)
inline constexpr std::int64_t k_most_file_bytes = std::int64_t(8) << 30;

/// What may stand behind a file's name.
enum class FileKinds {
    any,     ///< also a pipe or a device, which can be read only once: for names that the user gives
    regular  ///< for names that stand in files, and for what is read again later
};

/// The bytes of a whole file, as they were when it was opened. Another program may change or shorten the file
/// afterwards: the bytes stay as they are.
///
/// It is read and not mapped into memory: touching a page that a mapped file has lost ends the program (SIGBUS), and
/// what has been checked in a mapping may have changed when it is used. The bakes of a 4096 x 2048 .hdr file (34 MB) and
/// of a 16384 x 8192 .exr file (805 MB) take as long as with mapped files, and at most the file's size more memory.
class FileBytes {
  public:
    /// Errors: missing, not readable, empty, a folder; larger than k_most_file_bytes; a file that becomes shorter while
    /// it is read; a pipe or a device that is over `max_bytes`, or that `kinds` rules out. Throws std::bad_alloc.
    static Result<std::shared_ptr<const FileBytes>> open(const std::filesystem::path& file, std::int64_t max_bytes,
                                                         FileKinds kinds = FileKinds::any);
    static std::shared_ptr<const FileBytes> from_memory(std::vector<std::uint8_t> bytes);

    std::span<const std::uint8_t> bytes() const { return memory_; }
    /// Whether they came from a regular file, which can be read again.
    bool regular() const { return regular_; }

  private:
    FileBytes() = default;
    std::vector<std::uint8_t, LargeAllocator<std::uint8_t>> memory_;
    bool regular_ = false;
};

}  // namespace domelight
