#include "io/file/output_place.h"

#include "io/file/input_guard.h"
#include "io/file/temporary_files.h"

#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace domelight {
namespace {

namespace fs = std::filesystem;

/// 0, or the errno that creating a file in the folder would give.
int creation_error(const fs::path& folder) {
    std::error_code failure;
    const fs::file_status status = fs::status(folder, failure);
    if (!fs::exists(status)) return failure ? failure.value() : ENOENT;
    if (!fs::is_directory(status)) return ENOTDIR;
    if (::access(folder.c_str(), W_OK | X_OK) != 0) return errno;
    struct statvfs disk = {};
    if (::statvfs(folder.c_str(), &disk) != 0) return 0;
    // File systems that do not count blocks or files state none at all.
    const bool no_blocks = disk.f_blocks > 0 && disk.f_bavail == 0, no_files = disk.f_files > 0 && disk.f_favail == 0;
    return no_blocks || no_files ? ENOSPC : 0;
}

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

Result<void> check_output_file(const fs::path& file) {
    std::error_code failure;
    const fs::file_status status = fs::status(file, failure);
    if (fs::is_directory(status) || !file.has_filename())
        return Error{"is a folder, not a file", file.string(), "give the name of a file in it"};
    if (is_device(status)) {
        if (::access(file.c_str(), W_OK) == 0) return {};
        return system_error("be written to", errno).at(file.string());
    }
    const auto target = end_of_links(file);
    if (!target) return target.error().at(file.string());
    if (const int code = creation_error(folder_of(*target)))
        return Error{system_error("create a file there", code).what, file.string(),
                     code == ENOSPC ? "The disk is full." : "does the folder exist, and may you write to it?"};
    remove_abandoned_temporaries(folder_of(*target));
    return {};
}

Result<void> check_output_folder(const fs::path& folder) {
    std::error_code failure;
    const fs::path asked = folder.empty() ? fs::path(".") : folder;
    fs::path nearest = fs::absolute(asked, failure).lexically_normal();
    while (!fs::exists(nearest, failure) && nearest != nearest.parent_path()) nearest = nearest.parent_path();
    if (!fs::is_directory(nearest, failure))
        return Error{fs::exists(asked, failure) ? "is a file, not a folder" : system_error("be created", ENOTDIR).what,
                     folder.string(), "Name a folder for the results."};
    if (const int code = creation_error(nearest))
        return Error{system_error(fs::exists(asked, failure) ? "create a file there" : "be created", code).what,
                     folder.string(), code == ENOSPC ? "The disk is full." : ""};
    if (fs::is_directory(asked, failure)) remove_abandoned_temporaries(asked);
    return {};
}

Result<void> check_output_files(std::span<const fs::path> files, std::span<const fs::path> inputs) {
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (auto ok = check_output_file(files[i]); !ok) return ok;
        if (auto ok = check_not_an_input(files[i], inputs); !ok) return ok;
        std::error_code ignored;
        for (std::size_t k = 0; k < i; ++k)
            if (!is_device(fs::status(files[i], ignored)) &&
                (files[k].lexically_normal() == files[i].lexically_normal() ||
                 fs::equivalent(files[k], files[i], ignored)))
                return Error{"is named for two outputs", files[i].string(), "Name a file for each."};
    }
    return {};
}

}  // namespace domelight
