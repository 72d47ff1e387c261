// Files that appear whole or not at all.
#include "domelight/io/file/atomic_file.h"

#include "io/file/output_file.h"
#include "io/file/temporary_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

namespace domelight {

namespace fs = std::filesystem;

namespace {

Error system_error(const char* doing, int code) {
    return {std::string("cannot ") + doing + ": " + std::generic_category().message(code), "", ""};
}

/// Creates an empty file with a new name in the folder of `target`; returns its path, or the error. Its mode is that of
/// an ordinary new file, or of the file that it will replace.
Result<std::string> create_neighbour(const fs::path& target) {
    static std::atomic<unsigned> counter{0};
    // The leading dot and the ending hide it from globs; the name is shortened so that it stays below NAME_MAX with
    // both.
    std::string stem = target.filename().string().substr(0, 200);
    stem = '.' + stem + '.' + std::to_string(::getpid()) + '-';
    for (int attempt = 0; attempt < 1000; ++attempt) {
        const std::string path = (target.parent_path() / (stem + std::to_string(counter++) + ".tmp")).string();
        const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor < 0 && errno == EEXIST) continue;
        if (descriptor < 0) return system_error("create a file there", errno);
        struct stat old = {};
        if (::stat(target.c_str(), &old) == 0) (void)!::fchmod(descriptor, old.st_mode & 0777);
        ::close(descriptor);
        return path;
    }
    return system_error("create a file there", EEXIST);
}

}  // namespace

Result<void> write_file_atomically(const fs::path& file, const std::function<Result<void>(const fs::path&)>& write) {
    const std::string shown = file.string();
    std::error_code failure;
    const fs::file_status status = fs::status(file, failure);
    if (fs::is_directory(status)) return Error{"is a folder, not a file", shown, "give the name of a file in it"};
    // A device or pipe (/dev/stdout, a named pipe) cannot be replaced, only written to.
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        Result<void> written = write(file);
        return written ? written : Error{written.error().what, shown, written.error().hint};
    }
    // A link stays a link: the file that it points to is replaced.
    fs::path target = fs::is_symlink(file, failure) ? fs::canonical(file, failure) : fs::absolute(file, failure);
    if (failure || target.empty()) target = file;

    Result<std::string> temporary = create_neighbour(target);
    if (!temporary) return Error{temporary.error().what, shown, "does the folder exist, and may you write to it?"};
    const TemporaryFileGuard guard(*temporary);
    Result<void> written = write(*temporary);
    if (written && ::rename(temporary->c_str(), target.c_str()) != 0) written = system_error("replace it", errno);
    if (written) return written;
    ::unlink(temporary->c_str());
    return Error{written.error().what, shown, written.error().hint};
}

Result<void> write_file_atomically(const fs::path& file, std::span<const std::uint8_t> bytes) {
    return write_file_atomically(file, [&](const fs::path& temporary) {
        OutputFile out(temporary);
        out.write(bytes);
        return out.finish();
    });
}

}  // namespace domelight
