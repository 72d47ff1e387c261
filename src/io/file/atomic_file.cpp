// Files that appear whole or not at all.
#include "domelight/io/file/atomic_file.h"

#include "io/file/output_file.h"
#include "io/file/temporary_files.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>

namespace domelight {

namespace fs = std::filesystem;

namespace {

Result<void> replace(const fs::path& file, const std::function<Result<void>(const fs::path&)>& write) {
    FileGroup group;
    const Result<void> written = group.write(file, write);
    return written ? group.commit() : written;
}

}  // namespace

struct FileGroup::File {
    fs::path name, target;
    TemporaryFile temporary;
};

FileGroup::FileGroup() = default;

FileGroup::~FileGroup() {
    for (const File& file : files_) ::unlink(file.temporary.path.c_str());
}

Result<fs::path> FileGroup::stage(const fs::path& file) {
    std::error_code failure;
    if (is_device(fs::status(file, failure))) return file;
    auto target = end_of_links(file);
    if (!target) return target.error().at(file.string());
    auto temporary = create_temporary(*target);
    if (!temporary)
        return Error{temporary.error().what, file.string(), "does the folder exist, and may you write to it?"};
    files_.push_back({file, *std::move(target), *std::move(temporary)});
    return fs::path(files_.back().temporary.path);
}

Result<void> FileGroup::write(const fs::path& file, const std::function<Result<void>(const fs::path&)>& write) {
    const auto temporary = stage(file);
    if (!temporary) return temporary.error();
    const Result<void> written = write(*temporary);
    return written ? written : Error{written.error().what, file.string(), written.error().hint};
}

Result<void> FileGroup::commit() {
    std::error_code ignored;
    for (const File& file : files_)  // an obstacle that would otherwise stop the moving half way
        if (fs::is_directory(file.target, ignored))
            return Error{"is a folder, not a file", file.name.string(), "give the name of a file in it"};
    while (!files_.empty()) {
        const File& file = files_.front();
        if (::rename(file.temporary.path.c_str(), file.target.c_str()) != 0) {
            const Error failed = system_error("replace it", errno);
            return failed.at(file.name.string());
        }
        files_.erase(files_.begin());
    }
    return {};
}

Result<void> write_file_atomically(const fs::path& file, const std::function<Result<void>(const fs::path&)>& write) {
    std::error_code failure;
    const fs::file_status status = fs::status(file, failure);
    if (fs::is_directory(status))
        return Error{"is a folder, not a file", file.string(), "give the name of a file in it"};
    const bool direct = is_device(status) || TemporaryFileGuard::guards(file.string());
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

Result<void> write_file_atomically(const std::filesystem::path& file, std::string_view text) {
    return write_file_atomically(file, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace domelight
