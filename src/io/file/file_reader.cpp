#include "io/file/file_reader.h"

#include "io/file/byte_source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

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
Result<Bytes> drain(int fd, const std::filesystem::path& file, std::int64_t max_bytes) {
    Bytes all;
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

/// Reads a regular file of `size` bytes.
Result<Bytes> read_whole(int fd, const std::filesystem::path& file, std::int64_t size) {
    if (size > k_most_file_bytes)
        return Error{
            "has " + std::to_string(size) + " bytes, more than the limit of " + std::to_string(k_most_file_bytes),
            file.string(), ""};
    Bytes all(static_cast<std::size_t>(size));
    for (std::int64_t at = 0; at < size;) {
        const ssize_t n = pread(fd, all.data() + at, std::size_t(size - at), off_t(at));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return system_error(file, "reading");
        if (n == 0)
            return Error{
                "became shorter while it was read: " + std::to_string(at) + " bytes of " + std::to_string(size),
                file.string(), "Another program writes to it: try again when it has ended."};
        at += n;
    }
    return all;
}

}  // namespace

Result<std::shared_ptr<const FileBytes>> FileBytes::open(const std::filesystem::path& file, std::int64_t max_bytes,
                                                         FileKinds kinds) {
    // O_NONBLOCK: opening a pipe that is refused must not wait for its writer.
    const int flags = kinds == FileKinds::regular ? O_RDONLY | O_CLOEXEC | O_NONBLOCK : O_RDONLY | O_CLOEXEC;
    const Descriptor descriptor{::open(file.c_str(), flags)};
    if (descriptor.fd < 0) return Error{errno == ENOENT ? "no such file" : std::strerror(errno), file.string(), ""};
    struct stat about {};
    if (fstat(descriptor.fd, &about) != 0) return system_error(file, "stat");
    if (S_ISDIR(about.st_mode)) return Error{"is a folder, not a file", file.string(), ""};
    const bool regular = S_ISREG(about.st_mode);
    if (!regular && kinds == FileKinds::regular) return Error{"is not a regular file", file.string(), ""};

    // Files of the system, as in /proc, state no size.
    const bool whole = regular && about.st_size > 0;
    auto bytes = whole ? read_whole(descriptor.fd, file, about.st_size) : drain(descriptor.fd, file, max_bytes);
    if (!bytes) return bytes.error();
    if (bytes->empty()) return Error{"file is empty", file.string(), ""};
    std::shared_ptr<FileBytes> result(new FileBytes);
    result->memory_ = *std::move(bytes);
    result->regular_ = regular;
    return std::shared_ptr<const FileBytes>(std::move(result));
}

std::shared_ptr<const FileBytes> FileBytes::from_memory(std::vector<std::uint8_t> bytes) {
    std::shared_ptr<FileBytes> result(new FileBytes);
    result->memory_.assign(bytes.begin(), bytes.end());
    return result;
}

}  // namespace domelight
