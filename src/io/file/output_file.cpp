#include "io/file/output_file.h"

#include "io/file/temporary_files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <system_error>

namespace domelight {

OutputFile::OutputFile(const std::filesystem::path& path) {
    // Opening a pipe waits for its reader and must stay open to signals.
    std::optional<TemporaryFileCreation> creation;
    if (TemporaryFileGuard::guards(path.string())) creation.emplace();
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) error_ = errno;
}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(std::span<const std::uint8_t> bytes) {
    while (!error_ && !bytes.empty()) {
        const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) {
            error_ = n < 0 ? errno : ENOSPC;
            return;
        }
        position_ += std::uint64_t(n);
        bytes = bytes.subspan(std::size_t(n));
    }
}

void OutputFile::write(std::span<const char> bytes) {
    write(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
}

void OutputFile::write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes) {
    while (!error_ && !bytes.empty()) {
        const ssize_t n = ::pwrite(descriptor_, bytes.data(), bytes.size(), off_t(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) {
            int none = 0;
            error_.compare_exchange_strong(none, n < 0 ? errno : ENOSPC);
            return;
        }
        offset += std::uint64_t(n);
        bytes = bytes.subspan(std::size_t(n));
    }
}

void OutputFile::seek(std::uint64_t position) {
    if (error_) return;
    if (::lseek(descriptor_, off_t(position), SEEK_SET) < 0) error_ = errno;
    position_ = position;
}

Result<void> OutputFile::finish() {
    if (descriptor_ >= 0) {
        // Network file systems report a full disk only here.
        if (::close(descriptor_) != 0 && errno != EINTR && !error_) error_ = errno;
        descriptor_ = -1;
    }
    if (error_) return Error{"cannot write: " + std::generic_category().message(error_), "", ""};
    return {};
}

}  // namespace domelight
