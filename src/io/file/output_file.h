#pragma once

#include "domelight/base/result.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <span>

namespace domelight {

/// A file that is written through its descriptor, without a buffer, so write large pieces. The first failure (disk
/// full, file too large, ...) is remembered; later writes do nothing, and finish() returns the error.
class OutputFile {
  public:
    /// Opens and empties `path`, which need not exist.
    explicit OutputFile(const std::filesystem::path& path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::span<const std::uint8_t> bytes);
    void write(std::span<const char> bytes);
    /// Writes at a given offset without changing position(). May be called from several threads at once.
    void write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes);
    void seek(std::uint64_t position);
    std::uint64_t position() const { return position_; }
    bool failed() const { return error_ != 0; }
    /// Closes the file. Returns the first error of all, including that of closing.
    Result<void> finish();

  private:
    int descriptor_ = -1;
    std::atomic<int> error_{0};  ///< errno of the first failure
    std::uint64_t position_ = 0;
};

}  // namespace domelight
