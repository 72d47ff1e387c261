#pragma once

#include "domelight/base/result.h"

#include "base/mutex.h"
#include "io/file/temporary_files.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace domelight {

/// The files of one bake before they are complete. Each is first written under a temporary name in the target folder
/// (on the same file system, so that moving is instant); commit() moves all of them to their names. Files that have not
/// been committed are removed, even on signals that the program handles.
class Staging {
  public:
    /// Creates the folder if it is missing. `inputs`: files that commit() must not replace. Errors name the folder: those
    /// of check_output_folder().
    static Result<Staging> open(const std::filesystem::path& folder, std::vector<std::filesystem::path> inputs = {});
    Staging(Staging&&) = default;
    Staging& operator=(Staging&&) = delete;
    ~Staging();

    /// The path at which to write the file that will be called `name` (relative, may contain folders). Safe to call
    /// from several threads.
    std::filesystem::path stage(const std::string& name);
    /// Moves every file to its place, `last` (the manifest, which lists the others) at the end. Errors, before anything
    /// is moved: a file's place is one of the inputs, or a folder.
    Result<void> commit(const std::string& last);

  private:
    struct File {
        std::string name;
        std::filesystem::path temporary;
        std::unique_ptr<TemporaryFileGuard> guard;
    };
    Staging() = default;
    Result<void> move_to_place(const File& file) const;

    std::filesystem::path folder_;
    std::vector<std::filesystem::path> inputs_;
    std::vector<std::filesystem::path> created_folders_;  ///< outermost first
    std::vector<File> files_;
    std::unique_ptr<Mutex> mutex_ = std::make_unique<Mutex>();
};

}  // namespace domelight
