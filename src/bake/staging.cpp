#include "bake/staging.h"

#include "io/file/input_guard.h"
#include "io/file/output_place.h"

#include <unistd.h>

#include <system_error>

namespace domelight {

namespace fs = std::filesystem;

Result<Staging> Staging::open(const fs::path& folder, std::vector<fs::path> inputs) {
    Staging staging;
    staging.inputs_ = std::move(inputs);
    staging.folder_ = folder.empty() ? fs::path(".") : folder;
    if (auto ok = check_output_folder(staging.folder_); !ok) return ok.error();
    std::error_code failure;
    const fs::path absolute = fs::absolute(staging.folder_, failure).lexically_normal();
    for (fs::path p = absolute; !p.empty() && !fs::exists(p, failure) && p != p.parent_path(); p = p.parent_path())
        if (p.has_filename()) staging.created_folders_.insert(staging.created_folders_.begin(), p);
    fs::create_directories(staging.folder_, failure);
    if (failure) return Error{"cannot be created: " + failure.message(), folder.string(), ""};
    return staging;
}

Staging::~Staging() {
    std::error_code ignored;
    for (const File& file : files_) fs::remove(file.temporary, ignored);
    // Only empty folders are removed: a folder that has its files stays.
    for (auto p = created_folders_.rbegin(); p != created_folders_.rend(); ++p) ::rmdir(p->c_str());
}

fs::path Staging::stage(const std::string& name) {
    const Lock lock(*mutex_);
    // The ending of the name is kept, because some writers depend on it.
    const fs::path temporary = temporary_name(folder_ / fs::path(name).filename());
    files_.push_back({name, temporary, std::make_unique<TemporaryFileGuard>(temporary.string())});
    return temporary;
}

Result<void> Staging::move_to_place(const File& file) const {
    std::error_code failure;
    const fs::path place = folder_ / file.name;
    fs::create_directories(place.parent_path(), failure);
    if (!failure) fs::rename(file.temporary, place, failure);
    if (failure) return Error{"cannot be replaced: " + failure.message(), place.string(), ""};
    return {};
}

Result<void> Staging::commit(const std::string& last) {
    std::error_code ignored;
    for (const File& file : files_)
        if (auto ok = check_not_an_input(folder_ / file.name, inputs_); !ok) return ok;
    for (const File& file : files_)  // obstacles that would otherwise stop the moving half way
        if (std::filesystem::is_directory(folder_ / file.name, ignored))
            return Error{"is a folder, but a file of that name is to be written", (folder_ / file.name).string(),
                         "Move it away, or name another folder."};
    for (const bool manifest : {false, true})
        for (const File& file : files_)
            if ((file.name == last) == manifest)
                if (auto moved = move_to_place(file); !moved) return moved;
    files_.clear();
    return {};
}

}  // namespace domelight
