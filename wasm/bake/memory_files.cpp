// What writes files, in memory: in place of io/file/output_file.cpp, atomic_file.cpp, output_place.cpp, temporary_files.cpp and bake/staging.cpp. Nothing is temporary
// here: JavaScript takes the files of a call that succeeded, and clears those of one that failed.

#include "memory_files.h"

#include "domelight/domelight_c.h"
#include "domelight/io/file/atomic_file.h"

#include "bake/staging.h"
#include "io/file/output_file.h"
#include "io/file/output_place.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace domelight {

namespace fs = std::filesystem;

std::map<std::string, std::vector<std::uint8_t>>& memory_files() {
    static std::map<std::string, std::vector<std::uint8_t>> files;
    return files;
}

namespace {

/// Files that are being written; a descriptor is a place in this list.
std::vector<std::vector<std::uint8_t>*> open_files;

}  // namespace

OutputFile::OutputFile(const fs::path& path) : descriptor_(int(open_files.size())) {
    auto& bytes = memory_files()[path.string()];
    bytes.clear();
    open_files.push_back(&bytes);
}

OutputFile::~OutputFile() = default;

void OutputFile::write(std::span<const std::uint8_t> bytes) {
    write_at(position_, bytes);
    position_ += bytes.size();
}

void OutputFile::write(std::span<const char> bytes) {
    write(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
}

void OutputFile::write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes) {
    auto& file = *open_files[std::size_t(descriptor_)];
    if (file.size() < offset + bytes.size()) file.resize(std::size_t(offset + bytes.size()));
    std::copy(bytes.begin(), bytes.end(), file.begin() + std::ptrdiff_t(offset));
}

void OutputFile::seek(std::uint64_t position) {
    position_ = position;
}

Result<void> OutputFile::finish() {
    return {};
}

Result<void> write_file_atomically(const fs::path& file, const std::function<Result<void>(const fs::path&)>& write) {
    Result<void> written = write(file);
    return written ? written : written.error().at(file.string());
}

Result<void> write_file_atomically(const fs::path& file, std::span<const std::uint8_t> bytes) {
    memory_files()[file.string()].assign(bytes.begin(), bytes.end());
    return {};
}

Result<void> write_file_atomically(const fs::path& file, std::string_view text) {
    return write_file_atomically(file, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

Result<void> check_output_folder(const fs::path&) {
    return {};
}

TemporaryFileGuard::~TemporaryFileGuard() = default;

Result<Staging> Staging::open(const fs::path& folder, std::vector<fs::path>) {
    Staging staging;
    staging.folder_ = folder;
    return staging;
}

Staging::~Staging() = default;

fs::path Staging::stage(const std::string& name) {
    return folder_ / name;
}

Result<void> Staging::commit(const std::string&) {
    return {};
}

}  // namespace domelight

using namespace domelight;

extern "C" {

DOMELIGHT_API size_t domelight_memory_file_count() {
    return memory_files().size();
}

/// File `index`, in the order of the names: its name and its bytes, which are valid until the files are cleared.
DOMELIGHT_API void domelight_memory_file(size_t index, const char** name, const void** bytes, size_t* size) {
    const auto& [path, content] = *std::next(memory_files().begin(), std::ptrdiff_t(index));
    *name = path.c_str();
    *bytes = content.data();
    *size = content.size();
}

DOMELIGHT_API void domelight_memory_files_clear() {
    memory_files().clear();
    open_files.clear();
}

}  // extern "C"
