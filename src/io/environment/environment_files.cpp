#include "io/environment/environment_files.h"

#include "io/environment/cube_face_names.h"

#include <system_error>

namespace domelight {

std::vector<std::filesystem::path> environment_files(std::vector<std::filesystem::path> files,
                                                     const EnvironmentOptions& options) {
    std::error_code failure;
    if (files.size() == 1 && std::filesystem::is_directory(files[0], failure)) {
        const auto faces = cube_faces_in_folder(files[0]);
        if (faces.size() == 6) files = faces;
    }
    if (files.size() != 6) return files;
    const auto faces = options.faces.empty() ? cube_faces_by_name(files) : cube_faces_in_order(files, options.faces);
    if (faces) files.assign(faces->files.begin(), faces->files.end());
    return files;
}

}  // namespace domelight
