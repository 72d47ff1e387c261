#include "batch/claims.h"

#include "io/file/temporary_files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace domelight {
namespace {

#ifdef F_OFD_SETLK
constexpr int k_set_lock = F_OFD_SETLK;
#else
constexpr int k_set_lock = F_SETLK;
#endif

/// 48 bits of the id: a file's offset is below 2^63, and byte 0 is for the test of locks.
off_t offset_of(const std::string& job) {
    return off_t(std::stoull(job.substr(0, 12), nullptr, 16)) + 1;
}

/// 0, or the errno.
int set_lock(int descriptor, short type, off_t offset) {
    struct flock lock = {};
    lock.l_type = type;
    lock.l_whence = SEEK_SET;
    lock.l_start = offset;
    lock.l_len = 1;
    return ::fcntl(descriptor, k_set_lock, &lock) == 0 ? 0 : errno;
}

bool is_taken(int code) {
    return code == EAGAIN || code == EACCES;
}

}  // namespace

Result<Claims> Claims::open(const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) return system_error("open", errno).at(file.string());
    Claims claims(descriptor);
    const int code = set_lock(descriptor, F_WRLCK, 0);
    if (code != 0 && !is_taken(code)) {
        Error error = system_error("lock a byte of it", code).at(file.string());
        error.hint = "The batch needs a file system with locks (of Lustre: mounted with the option flock).";
        return error;
    }
    if (code == 0) (void)set_lock(descriptor, F_UNLCK, 0);
    return claims;
}

Claims::Claims(Claims&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

Claims::~Claims() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

bool Claims::take(const std::string& job) {
    return set_lock(descriptor_, F_WRLCK, offset_of(job)) == 0;
}

void Claims::release(const std::string& job) {
    (void)set_lock(descriptor_, F_UNLCK, offset_of(job));
}

}  // namespace domelight
