#include "domelight/io/file/file_extension.h"
#include "domelight/scene/scene.h"

#include "io/image_reader.h"
#include "scene/scene_readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

namespace domelight {

namespace {

Result<Scene> read_scene(const std::filesystem::path& file, std::shared_ptr<const FileBytes> bytes,
                         const SceneOptions& options) {
    const std::string extension = lower_case_extension(file);
    const auto starts = [&](std::string_view magic) {
        const auto all = bytes->bytes();
        return all.size() >= magic.size() && std::equal(magic.begin(), magic.end(), all.begin());
    };
    const std::filesystem::path folder = file.parent_path();
    if (starts("glTF") || extension == ".gltf" || extension == ".glb")
        return read_gltf(std::move(bytes), folder, options);
    if (starts("ply\n") || starts("ply\r")) return read_ply(std::move(bytes), options);
    if (extension == ".ply") return Error{"not a PLY file", "", ""};
    if (extension == ".obj") return read_obj(std::move(bytes), folder, options);
    return Error{fmt::format("'{}' is not a kind of scene that is read", printable(extension)), "",
                 "Scenes are .gltf, .glb, .obj or .ply."};
}

}  // namespace

Result<Scene> load_scene(const std::filesystem::path& file, const SceneOptions& options) {
    auto bytes = FileBytes::open(file, options.max_bytes);
    if (!bytes) return bytes.error();
    try {
        auto scene = read_scene(file, std::move(*bytes), options);
        if (!scene) return scene.error().at(file.string());
        if (scene->instances.empty()) return Error{"there are no triangles in it", file.string(), ""};
        return scene;
    } catch (const std::bad_alloc&) {
        return Error{"there is not enough memory for this scene", file.string(), ""};
    }
}

}  // namespace domelight
