#pragma once

#include "domelight/base/result.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace domelight {

/// SHA-256 (FIPS 180-4) of bytes that arrive piece by piece.
class Sha256 {
  public:
    Sha256();
    ~Sha256();
    Sha256(Sha256&&) noexcept;
    Sha256& operator=(Sha256&&) noexcept;

    void add(std::span<const std::uint8_t> bytes);
    /// 64 lower-case hexadecimal digits. May be called once.
    std::string finish();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

inline std::string sha256(std::span<const std::uint8_t> bytes) {
    Sha256 hash;
    hash.add(bytes);
    return hash.finish();
}

/// Hash of a regular file's content, read in pieces; of several files: of their contents one after the other. Errors
/// name the file: not there, not readable, a pipe or a device.
Result<std::string> sha256_files(std::span<const std::filesystem::path> files);
inline Result<std::string> sha256_file(const std::filesystem::path& file) {
    return sha256_files({&file, 1});
}

/// The same of the file that a file in `folder`, such as a manifest, calls `name`. Errors also: it is not in the folder
/// (path_inside).
Result<std::string> sha256_in_folder(const std::filesystem::path& folder, const std::string& name);

}  // namespace domelight
