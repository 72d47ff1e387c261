// Files of the module: bytes in memory, and no others.

#include "io/file/byte_source.h"
#include "io/file/file_reader.h"

#include <filesystem>
#include <string_view>

namespace domelight {

namespace {

Error no_files(const std::filesystem::path& file) {
    return {"the WebAssembly module opens no files", file.string(), "Give it the bytes of the file."};
}

}  // namespace

Result<std::shared_ptr<const FileBytes>> FileBytes::open(const std::filesystem::path& file, std::int64_t, FileKinds) {
    return no_files(file);
}

std::shared_ptr<const FileBytes> FileBytes::from_memory(std::vector<std::uint8_t> bytes) {
    std::shared_ptr<FileBytes> made(new FileBytes);
    made->memory_.assign(bytes.begin(), bytes.end());
    return made;
}

Result<FileSource> FileSource::open(const std::filesystem::path& file) {
    return no_files(file);
}
FileSource::~FileSource() = default;
FileSource::FileSource(FileSource&& other) noexcept = default;
Result<void> FileSource::read(std::uint64_t, std::span<std::uint8_t>, const char*) {
    return no_files("");
}

}  // namespace domelight
