#include "scene/scene_files.h"

#include "domelight/io/file/file_extension.h"
#include "domelight/scene/scene.h"

#include "io/file/file_reader.h"
#include "io/file/json.h"
#include "io/file/path_inside.h"
#include "io/file/text_fields.h"
#include "scene/gltf/gltf_chunks.h"
#include "scene/gltf/gltf_uri.h"
#include "scene/mesh/mtl_reader.h"

#include <algorithm>
#include <map>
#include <string>

namespace domelight {
namespace {

namespace fs = std::filesystem;

/// Collects the files that are there, relative to the scene's folder.
class NamedFiles {
  public:
    explicit NamedFiles(fs::path folder) : folder_(std::move(folder)) {
        std::error_code failure;
        root_ = fs::weakly_canonical(fs::absolute(folder_.empty() ? "." : folder_, failure), failure);
    }

    /// The path as path_inside() returns it.
    void add(const Result<fs::path>& path) {
        std::error_code failure;
        if (!path || !fs::is_regular_file(*path, failure)) return;
        const fs::path name = path->lexically_relative(root_);
        if (std::ranges::find(files_, name) == files_.end()) files_.push_back(name);
    }

    const fs::path& folder() const { return folder_; }
    std::vector<fs::path> take() { return std::move(files_); }

  private:
    fs::path folder_, root_;
    std::vector<fs::path> files_;
};

Result<void> add_of_gltf(std::span<const std::uint8_t> bytes, NamedFiles& files) {
    const auto chunks = split_gltf(bytes);
    if (!chunks) return chunks.error();
    const auto json = Json::parse(chunks->json);
    if (!json) return json.error();
    const Json& document = *json;
    for (const char* list : {"buffers", "images"})
        for (const Json& item : document[list].elements()) {
            const Json* uri = item.find("uri");
            if (uri && uri->is_string() && !is_data_uri(uri->get<std::string>()))
                files.add(path_of_uri(uri->get<std::string>(), files.folder()));
        }
    return {};
}

std::string_view text_of(const FileBytes& file) {
    return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

/// The pictures of a .mtl file.
void add_of_mtl(const fs::path& library, NamedFiles& files) {
    const auto file = FileBytes::open(library, std::int64_t(1) << 30, FileKinds::regular);
    if (!file) return;
    Scene scene;
    std::map<std::string, int, std::less<>> numbers;
    std::vector<SceneImageSource> pictures;
    read_mtl(text_of(**file), library.parent_path(), files.folder(), scene, numbers, pictures);
    for (const SceneImageSource& picture : pictures)
        files.add(path_inside(library.parent_path() / picture.name, files.folder(), picture.name));
}

void add_of_obj(std::string_view text, NamedFiles& files) {
    TextLines lines(text);
    for (std::string_view line; lines.next(line);) {
        if (take_word(line) != "mtllib") continue;
        const std::string name(trimmed(line));
        const auto library = path_inside(files.folder() / name, files.folder(), name);
        files.add(library);
        if (library) add_of_mtl(*library, files);
    }
}

}  // namespace

Result<std::vector<fs::path>> files_named_by_scene(const fs::path& scene) {
    const auto file = FileBytes::open(scene, SceneOptions{}.max_bytes);
    if (!file) return file.error();
    NamedFiles files(scene.parent_path());
    const std::string extension = lower_case_extension(scene);
    if (extension == ".gltf" || extension == ".glb") {
        if (auto ok = add_of_gltf((*file)->bytes(), files); !ok) return ok.error().at(scene.string());
    } else if (extension == ".obj") {
        add_of_obj(text_of(**file), files);
    }
    return files.take();
}

}  // namespace domelight
