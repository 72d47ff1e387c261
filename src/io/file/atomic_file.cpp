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
#include <memory>
#include <string>
#include <system_error>

namespace domelight {

namespace fs = std::filesystem;

namespace {

Error system_error(const char* doing, int code) {
    return {std::string("cannot ") + doing + ": " + std::generic_category().message(code), "", ""};
}

/// An empty file beside the one that it is to replace; removed with this object, or when a signal ends the program.
struct Neighbour {
    std::string path;
    std::unique_ptr<TemporaryFileGuard> guard;
};

/// Creates it under a name nobody has. The mode is the one an ordinary new file gets, or that of the file which it is
/// to replace.
Result<Neighbour> create_neighbour(const fs::path& target) {
    static std::atomic<unsigned> counter{0};
    // The leading dot and the ending hide it from globs; the name is shortened so that it stays below NAME_MAX with
    // both.
    std::string stem = target.filename().string().substr(0, 200);
    stem = '.' + stem + '.' + std::to_string(::getpid()) + '-';
    for (int attempt = 0; attempt < 1000; ++attempt) {
        const std::string path = (target.parent_path() / (stem + std::to_string(counter++) + ".tmp")).string();
        const TemporaryFileCreation creation;
        const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor < 0 && errno == EEXIST) continue;
        if (descriptor < 0) return system_error("create a file there", errno);
        struct stat old = {};
        if (::stat(target.c_str(), &old) == 0) (void)!::fchmod(descriptor, old.st_mode & 0777);
        ::close(descriptor);
        return Neighbour{path, std::make_unique<TemporaryFileGuard>(path)};
    }
    return system_error("create a file there", EEXIST);
}

/// Where a chain of links ends, whether there is a file or not. The last name alone may be a link that leads nowhere.
Result<fs::path> end_of_links(fs::path file) {
    constexpr int k_most_links = 40;  // as many as Linux follows
    std::error_code failure;
    for (int links = 0; fs::is_symlink(fs::symlink_status(file, failure)); ++links) {
        if (links == k_most_links) return system_error("follow its links", ELOOP);
        const fs::path next = fs::read_symlink(file, failure);
        if (failure) return system_error("follow its links", failure.value());
        file = file.parent_path() / next;  // `next` alone where that is absolute
    }
    return file;
}

Result<void> replace(const fs::path& file, const std::function<Result<void>(const fs::path&)>& write) {
    const Result<fs::path> target = end_of_links(file);
    if (!target) return target.error();
    const Result<Neighbour> temporary = create_neighbour(*target);
    if (!temporary) return Error{temporary.error().what, "", "does the folder exist, and may you write to it?"};
    Result<void> written = write(temporary->path);
    if (written && ::rename(temporary->path.c_str(), target->c_str()) != 0) written = system_error("replace it", errno);
    if (!written) ::unlink(temporary->path.c_str());
    return written;
}

}  // namespace

Result<void> write_file_atomically(const fs::path& file, const std::function<Result<void>(const fs::path&)>& write) {
    std::error_code failure;
    const fs::file_status status = fs::status(file, failure);
    if (fs::is_directory(status))
        return Error{"is a folder, not a file", file.string(), "give the name of a file in it"};
    // A device or pipe (/dev/stdout, a named pipe) cannot be replaced, only written to.
    const bool direct =
        (fs::exists(status) && !fs::is_regular_file(status)) || TemporaryFileGuard::guards(file.string());
    const Result<void> written = direct ? write(file) : replace(file, write);
    return written ? written : Error{written.error().what, file.string(), written.error().hint};
}

Result<void> write_file_atomically(const fs::path& file, std::span<const std::uint8_t> bytes) {
    return write_file_atomically(file, [&](const fs::path& temporary) {
        OutputFile out(temporary);
        out.write(bytes);
        return out.finish();
    });
}

}  // namespace domelight
