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

/// A manifest, and the member of it that describes a file.
struct Entry {
    Json manifest, map;
};

std::optional<Entry> entry_in(const std::filesystem::path& manifest, const std::string& file) {
    const auto parsed = Json::read(manifest);
    if (!parsed || !parsed->is_object()) return std::nullopt;
    const Json& json = *parsed;
    for (const char* role : {"specular", "sheen", "skybox", "environment", "irradiance"})
        if (json.contains(role) && names_file(json[role], file)) return Entry{json, json[role]};
    return std::nullopt;
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

std::optional<Entry> entry_of(const std::filesystem::path& file) {
    for (const Candidate& c : candidates(file))
        if (auto found = entry_in(c.manifest, c.name)) return found;
    return std::nullopt;
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

std::optional<std::filesystem::path> manifest_naming(const std::filesystem::path& file) {
    for (const Candidate& c : candidates(file))
        if (entry_in(c.manifest, c.name)) return c.manifest;
    return std::nullopt;
}

std::optional<std::string> projection_in_manifest(const std::filesystem::path& file) {
    const auto entry = entry_of(file);
    const auto projection = entry ? text_at(entry->map, "projection") : std::nullopt;
    return projection && projection_from_name(*projection) ? projection : std::nullopt;
}

ManifestEngine engine_in_manifest(const std::filesystem::path& file) {
    const auto entry = entry_of(file);
    if (!entry) return {};
    return {text_at(entry->manifest["engine"], "name").value_or(""),
            text_at(entry->map, "container") == name_of(Container::playcanvas_atlas)};
}

std::map<std::string, std::string> filter_in_manifest(const std::filesystem::path& file) {
    const auto entry = entry_of(file);
    if (!entry) return {};
    if (const auto stated = text_at(entry->map, "sha256")) {
        const auto now = sha256_file(file);
        if (!now || *now != *stated) return {};
    }
    std::map<std::string, std::string> keys;
    const auto add = [&](const char* name, const std::optional<std::string>& text) {
        if (text && !text->empty()) keys[name] = *text;
    };
    add("domelight.lobe", text_at(entry->map, "lobe"));
    add("domelight.texels", text_at(entry->manifest["options"], "texels"));
    add("domelight.roughness", numbers_of_levels(entry->map, "roughness"));
    add("domelight.exponent", numbers_of_levels(entry->map, "exponent"));
    return keys;
}

}  // namespace domelight
