#include "io/file/file_reader.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace domelight {

namespace {

/// Closes a file descriptor at the end of the scope.
struct Descriptor {
    int fd;
    ~Descriptor() {
        if (fd >= 0) close(fd);
    }
};

Error system_error(const std::filesystem::path& file, const char* doing) {
    return {std::string(doing) + " failed: " + std::strerror(errno), file.string(), ""};
}

/// Reads everything from a pipe or device, up to `max_bytes`.
Result<std::vector<std::uint8_t>> drain(int fd, const std::filesystem::path& file, std::int64_t max_bytes) {
    std::vector<std::uint8_t> all;
    std::uint8_t block[1 << 16];
    for (;;) {
        const ssize_t n = read(fd, block, sizeof block);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return system_error(file, "reading");
        if (n == 0) return all;
        all.insert(all.end(), block, block + n);
        if (std::int64_t(all.size()) > max_bytes)
            return Error{"more than " + std::to_string(max_bytes) + " bytes", file.string(), ""};
    }
}

}  // namespace

Result<std::shared_ptr<const FileBytes>> FileBytes::open(const std::filesystem::path& file, std::int64_t max_bytes) {
    const Descriptor descriptor{::open(file.c_str(), O_RDONLY | O_CLOEXEC)};
    if (descriptor.fd < 0) return Error{errno == ENOENT ? "no such file" : std::strerror(errno), file.string(), ""};
    struct stat about {};
    if (fstat(descriptor.fd, &about) != 0) return system_error(file, "stat");
    if (S_ISDIR(about.st_mode)) return Error{"is a folder, not an image", file.string(), ""};

    std::shared_ptr<FileBytes> result(new FileBytes);
    if (S_ISREG(about.st_mode) && about.st_size > 0) {
        void* mapping = mmap(nullptr, std::size_t(about.st_size), PROT_READ, MAP_PRIVATE, descriptor.fd, 0);
        if (mapping != MAP_FAILED) {
            result->mapping_ = mapping;
            result->data_ = static_cast<const std::uint8_t*>(mapping);
            result->size_ = std::size_t(about.st_size);
        }
    }
    if (!result->mapping_) {
        Result<std::vector<std::uint8_t>> bytes = drain(descriptor.fd, file, max_bytes);
        if (!bytes) return bytes.error();
        result->memory_ = std::move(*bytes);
        result->data_ = result->memory_.data();
        result->size_ = result->memory_.size();
    }
    if (result->size_ == 0) return Error{"file is empty", file.string(), ""};
    return std::shared_ptr<const FileBytes>(std::move(result));
}

std::shared_ptr<const FileBytes> FileBytes::from_memory(std::vector<std::uint8_t> bytes) {
    std::shared_ptr<FileBytes> result(new FileBytes);
    result->memory_ = std::move(bytes);
    result->data_ = result->memory_.data();
    result->size_ = result->memory_.size();
    return result;
}

FileBytes::~FileBytes() {
    if (mapping_) munmap(mapping_, size_);
}

std::size_t FileBytes::release(std::size_t first, std::size_t end) const {
    first = first / k_release_step * k_release_step;
    end = end / k_release_step * k_release_step;
    if (mapping_ && end > first) madvise(static_cast<char*>(mapping_) + first, end - first, MADV_DONTNEED);
    return std::max(first, end);
}

}  // namespace domelight
