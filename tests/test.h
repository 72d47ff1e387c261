#pragma once
// Included by every test file: doctest, the folder of shared test data, and temporary folders.

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace domelight::test {

/// Records that the running test case is skipped, and why.
void note_skip(const char* why);

/// The folder of shared test data that the environment variable DOMELIGHT_DATA names, if any.
inline std::optional<std::filesystem::path> data_folder() {
    const char* folder = std::getenv("DOMELIGHT_DATA");
    if (!folder || !std::filesystem::is_directory(folder)) return std::nullopt;
    return std::filesystem::path(folder);
}

/// A new folder that is removed with all in it at the end of the scope.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "domelight-test-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

}  // namespace domelight::test

/// Skips the test case if the file does not exist under DOMELIGHT_DATA; otherwise defines `name` as its path.
#define DOMELIGHT_DATA_FILE(name, relative)                                        \
    const auto name##_folder = ::domelight::test::data_folder();                   \
    if (!name##_folder || !std::filesystem::exists(*name##_folder / (relative))) { \
        ::domelight::test::note_skip("DOMELIGHT_DATA has no " relative);           \
        return;                                                                    \
    }                                                                              \
    const std::filesystem::path name = *name##_folder / (relative)
