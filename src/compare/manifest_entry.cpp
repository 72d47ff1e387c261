#include "compare/manifest_entry.h"

#include "domelight/engines/engine.h"
#include "domelight/projection/projections.h"

#include "io/file/json.h"
#include "io/file/sha256.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

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

/// The member of a manifest that describes a file; null where it says nothing of the file.
const Json* map_of(const Json& manifest, const std::string& file) {
    if (!manifest.is_object()) return nullptr;
    for (const char* role : {"specular", "sheen", "skybox", "environment", "irradiance"})
        if (manifest.contains(role) && names_file(manifest[role], file)) return &manifest[role];
    return nullptr;
}

/// A manifest that may describe a file, and the file's name in it.
struct Candidate {
    std::filesystem::path manifest;
    std::string name;
};
/// In the file's folder, and in the one above it.
std::vector<Candidate> candidates(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.parent_path();
    const std::string name = file.filename().generic_string();
    std::vector<Candidate> all{{folder / "manifest.json", name}};
    if (folder.has_filename())
        all.push_back({folder.parent_path() / "manifest.json", (folder.filename() / name).generic_string()});
    return all;
}

/// The numbers of all levels, "0 0.25 0.5"; nothing where a level has none.
std::string numbers_of_levels(const Json& map, const char* key) {
    std::string text;
    for (const Json& level : map["levels"].elements()) {
        const Json& value = level[key];
        const bool infinite = value.is_string() && value.get<std::string>() == "inf";
        if (!value.is_number() && !infinite) return "";
        text += (text.empty() ? "" : " ") + (infinite ? "inf" : fmt::format("{}", value.get<double>()));
    }
    return text;
}

}  // namespace

std::optional<ManifestEntry> ManifestEntry::of(const std::filesystem::path& file) {
    for (const Candidate& c : candidates(file)) {
        const auto document = Json::read(c.manifest);
        if (!document) continue;
        if (const Json* map = map_of(*document, c.name)) return ManifestEntry(file, c.manifest, *document, *map);
    }
    return std::nullopt;
}

std::optional<std::string> ManifestEntry::projection() const {
    const auto projection = text_at(map_, "projection");
    return projection && projection_from_name(*projection) ? projection : std::nullopt;
}

std::string ManifestEntry::engine() const {
    return text_at(document_["engine"], "name").value_or("");
}

bool ManifestEntry::is_atlas() const {
    return text_at(map_, "container") == name_of(Container::playcanvas_atlas);
}

std::map<std::string, std::string> ManifestEntry::filter() const {
    if (const auto stated = text_at(map_, "sha256")) {
        const auto now = sha256_file(file_);
        if (!now || *now != *stated) return {};
    }
    std::map<std::string, std::string> keys;
    const auto add = [&](const char* name, const std::optional<std::string>& text) {
        if (text && !text->empty()) keys[name] = *text;
    };
    add("domelight.lobe", text_at(map_, "lobe"));
    add("domelight.texels", text_at(document_["options"], "texels"));
    add("domelight.roughness", numbers_of_levels(map_, "roughness"));
    add("domelight.exponent", numbers_of_levels(map_, "exponent"));
    return keys;
}

}  // namespace domelight
