#include "io/file/path_inside.h"

#include "io/file/printable.h"

#include <algorithm>
#include <system_error>

namespace domelight {

Result<std::filesystem::path> path_inside(const std::filesystem::path& path, const std::filesystem::path& folder,
                                          std::string_view shown) {
    std::error_code failed;
    // Links are followed: one that leads out of the folder leaves it as ".." does. From absolute paths: a relative one
    // that does not exist at all would stay relative.
    const auto resolved = [&](const std::filesystem::path& p) {
        const std::filesystem::path absolute = std::filesystem::absolute(p, failed);
        return failed ? p : std::filesystem::weakly_canonical(absolute, failed);
    };
    const std::filesystem::path root = resolved(folder.empty() ? "." : folder);
    const std::filesystem::path found = failed ? root : resolved(path);
    if (failed) return Error{printable(shown, 80) + ": " + failed.message(), "", ""};
    if (std::mismatch(root.begin(), root.end(), found.begin(), found.end()).first != root.end())
        return Error{printable(shown, 80) + ": leaves the folder of the file that names it", "",
                     "Only files in that folder are read."};
    return found;
}

}  // namespace domelight
