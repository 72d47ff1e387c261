#pragma once

#include "domelight/base/result.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace domelight {

/// The files that may be read, by the path of their address. An address that is not in the table does not exist: no path
/// is ever put together from what a request says.
class ServedFiles {
  public:
    struct File {
        std::filesystem::path place;
        std::string type;  ///< its media type
    };

    /// All regular files below a folder, as "/" + their path in it, and index.html also as "/". Symbolic links are left
    /// out. Errors: there is no index.html.
    Result<void> add_app(const std::filesystem::path& folder);
    /// A .glb or .gltf as "/files/scene/NAME", and at the paths by which it names them the buffers and images of a .gltf.
    /// Those outside of its folder are left out. Returns the scene's address. Errors: another ending; it cannot be read.
    Result<std::string> add_scene(const std::filesystem::path& scene);
    /// A file of an environment as "/files/environment/NUMBER/NAME"; returns that address. Errors: it cannot be read.
    Result<std::string> add_environment(const std::filesystem::path& file, int number);

    /// probes.json of a set of probes, and the files of cubes that it names, as "/files/probes/NAME"; returns their
    /// addresses, that of probes.json first. Errors: probes.json is missing or damaged; a file is missing or outside of
    /// the folder.
    Result<std::vector<std::string>> add_probes(const std::filesystem::path& folder);

    /// Null where the address does not exist.
    const File* find(const std::string& address) const;

  private:
    std::map<std::string, File> files_;
};

/// The media type of a file by its ending; application/octet-stream for those that are not known.
std::string media_type(const std::filesystem::path& file);

}  // namespace domelight
