#pragma once

#include "domelight/base/result.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <span>

namespace domelight {

/// A file being written through its descriptor: no buffer of its own, so hand it large pieces. Remembers its first
/// failure (disk full, file too large, ...); later writes do nothing, and finish() tells.
class OutputFile {
  public:
    /// Opens and empties `path`, which need not exist.
    explicit OutputFile(const std::filesystem::path& path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::span<const std::uint8_t> bytes);
    void write(std::span<const char> bytes);
    /// At a place of its own, leaving position() as it is. May be called from several threads at once.
    void write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes);
    void seek(std::uint64_t position);
    std::uint64_t position() const { return position_; }
    bool failed() const { return error_ != 0; }
    /// Closes. The first error of all, closing included.
    Result<void> finish();

  private:
    int descriptor_ = -1;
    std::atomic<int> error_{0};  ///< errno of the first failure
    std::uint64_t position_ = 0;
};

}  // namespace domelight
