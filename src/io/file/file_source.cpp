#include "io/file/byte_source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

namespace domelight {

Result<FileSource> FileSource::open(const std::filesystem::path& file) {
    const auto failed = [&](int code) {
        return Error{"cannot read: " + std::generic_category().message(code), file.string(), ""};
    };
    // O_NONBLOCK: opening a named pipe must not wait for a writer.
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) return failed(errno);
    FileSource source(descriptor, 0);
    struct stat facts = {};
    if (::fstat(descriptor, &facts) != 0) return failed(errno);
    if (S_ISDIR(facts.st_mode)) return failed(EISDIR);
    if (!S_ISREG(facts.st_mode)) return Error{"is not a regular file", file.string(), ""};
    source.size_ = std::uint64_t(facts.st_size);
    return source;
}

FileSource::~FileSource() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

FileSource::FileSource(FileSource&& other) noexcept : descriptor_(other.descriptor_), size_(other.size_) {
    other.descriptor_ = -1;
}

Result<void> FileSource::read(std::uint64_t offset, std::span<std::uint8_t> out, const char* what) {
    if (!contains(offset, out.size())) return truncated(offset, out.size(), what);
    while (!out.empty()) {
        const ssize_t n = ::pread(descriptor_, out.data(), out.size(), off_t(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return Error{"cannot read: " + std::generic_category().message(errno), "", ""};
        if (n == 0) return truncated(offset, out.size(), what);  // the file has become shorter meanwhile
        offset += std::uint64_t(n);
        out = out.subspan(std::size_t(n));
    }
    return {};
}

}  // namespace domelight
