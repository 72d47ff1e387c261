#include "compare/latlong_level.h"

#include "io/file/json.h"

#include <algorithm>

namespace domelight {
namespace {

std::optional<std::string> text_at(const Json& json, const char* key) {
    if (!json.is_object() || !json.contains(key) || !json[key].is_string()) return std::nullopt;
    return json[key].get<std::string>();
}

/// Whether a map of the manifest is stored in this file, or one of its levels.
bool names_file(const Json& map, const std::string& file) {
    if (text_at(map, "file") == file) return true;
    if (!map.is_object() || !map.contains("levels") || !map["levels"].is_array()) return false;
    const auto& levels = map["levels"].elements();
    return std::any_of(levels.begin(), levels.end(), [&](const Json& level) { return text_at(level, "file") == file; });
}

std::optional<std::string> projection_of(const std::filesystem::path& manifest, const std::string& file) {
    const auto parsed = Json::read(manifest);
    if (!parsed || !parsed->is_object()) return std::nullopt;
    const Json& json = *parsed;
    for (const char* role : {"specular", "sheen", "skybox", "environment", "irradiance"}) {
        if (!json.contains(role) || !names_file(json[role], file)) continue;
        const auto projection = text_at(json[role], "projection");
        if (projection && projection_from_name(*projection)) return projection;
    }
    return std::nullopt;
}

}  // namespace

std::optional<std::string> projection_in_manifest(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.parent_path();
    const std::string name = file.filename().generic_string();
    if (auto found = projection_of(folder / "manifest.json", name)) return found;
    if (!folder.has_filename()) return std::nullopt;
    return projection_of(folder.parent_path() / "manifest.json", (folder.filename() / name).generic_string());
}

Cubemap cube_of_latlong_level(const ProjectedImage& level, int threads) {
    const int size = std::max(1, level.width() / 4);
    return Cubemap(reproject(level, *projection_from_name("cube"), size, size, threads).pixels);
}

}  // namespace domelight
