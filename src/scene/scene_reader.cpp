#include "domelight/io/file/file_extension.h"
#include "domelight/scene/scene.h"

#include "io/file/printable.h"
#include "io/image_reader.h"
#include "scene/scene_readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

namespace domelight {

namespace {

bool starts_with(const FileBytes& bytes, std::string_view magic) {
    const auto all = bytes.bytes();
    return all.size() >= magic.size() && std::equal(magic.begin(), magic.end(), all.begin());
}

bool is_gltf(const std::filesystem::path& file, const FileBytes& bytes) {
    const std::string extension = lower_case_extension(file);
    return starts_with(bytes, "glTF") || extension == ".gltf" || extension == ".glb";
}

Result<Scene> read_scene(const std::filesystem::path& file, std::shared_ptr<const FileBytes> bytes,
                         const SceneOptions& options) {
    const std::string extension = lower_case_extension(file);
    const std::filesystem::path folder = file.parent_path();
    if (is_gltf(file, *bytes)) return read_gltf(std::move(bytes), folder, options);
    if (starts_with(*bytes, "ply\n") || starts_with(*bytes, "ply\r")) return read_ply(std::move(bytes), options);
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
        if (scene->instances.empty()) return Error{"the scene has no triangles", file.string(), ""};
        return scene;
    } catch (const std::bad_alloc&) {
        return Error{"there is not enough memory for this scene", file.string(), ""};
    }
}

Result<EnvironmentLights> load_environment_lights(const std::filesystem::path& file, const SceneOptions& options) {
    auto bytes = FileBytes::open(file, options.max_bytes);
    if (!bytes) return bytes.error();
    if (!is_gltf(file, **bytes))
        return Error{"is not a glTF file", file.string(), "`domelight lights` writes the lights as lights.gltf."};
    try {
        auto lights = read_gltf_lights(std::move(*bytes), file.parent_path(), options);
        return lights ? lights : lights.error().at(file.string());
    } catch (const std::bad_alloc&) {
        return Error{"there is not enough memory for this file", file.string(), ""};
    }
}

}  // namespace domelight
