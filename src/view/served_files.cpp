#include "view/served_files.h"

#include "domelight/io/file/file_extension.h"

#include "io/file/json.h"
#include "io/file/path_inside.h"
#include "probe/probe_record.h"
#include "scene/gltf/gltf_uri.h"

#include <fmt/core.h>

#include <array>
#include <utility>

namespace domelight {
namespace fs = std::filesystem;

namespace {

constexpr std::array<std::pair<const char*, const char*>, 22> k_media_types{{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".webmanifest", "application/manifest+json"},
    {".txt", "text/plain; charset=utf-8"},
    {".md", "text/plain; charset=utf-8"},
    {".glsl", "text/plain; charset=utf-8"},
    {".wasm", "application/wasm"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".jpg", "image/jpeg"},
    {".jpeg", "image/jpeg"},
    {".webp", "image/webp"},
    {".ico", "image/x-icon"},
    {".woff2", "font/woff2"},
    {".glb", "model/gltf-binary"},
    {".gltf", "model/gltf+json"},
    {".ktx2", "image/ktx2"},
    {".hdr", "image/vnd.radiance"},
}};

Result<void> check_readable(const fs::path& file) {
    std::error_code code;
    if (fs::is_regular_file(file, code)) return {};
    return Error{"there is no such file", file.string(), ""};
}

/// What the buffers and images of a glTF file name.
std::vector<std::string> uris_of(const Json& gltf) {
    std::vector<std::string> uris;
    for (const char* list : {"buffers", "images"}) {
        const Json* found = gltf.find(list);
        if (!found) continue;
        for (const Json& element : found->elements())
            if (const Json* uri = element.find("uri"); uri && uri->is_string()) uris.push_back(uri->get<std::string>());
    }
    return uris;
}

}  // namespace

std::string media_type(const fs::path& file) {
    const std::string ending = lower_case_extension(file);
    for (const auto& [known, type] : k_media_types)
        if (ending == known) return type;
    return "application/octet-stream";
}

Result<void> ServedFiles::add_app(const fs::path& folder) {
    std::error_code code;
    const fs::path index = folder / "index.html";
    if (!fs::is_regular_file(index, code)) return Error{"there is no index.html", folder.string(), ""};
    for (auto at = fs::recursive_directory_iterator(folder, code); !code && at != fs::recursive_directory_iterator();
         at.increment(code))
        if (at->symlink_status().type() == fs::file_type::regular)
            files_["/" + at->path().lexically_relative(folder).generic_string()] = {at->path(), media_type(at->path())};
    if (code) return Error{"cannot be listed: " + code.message(), folder.string(), ""};
    // A folder's address stands for the page in it.
    std::map<std::string, File> pages;
    for (const auto& [address, file] : files_)
        if (address.ends_with("/index.html")) pages[address.substr(0, address.size() - 10)] = file;
    files_.merge(pages);
    return {};
}

Result<std::string> ServedFiles::add_scene(const fs::path& scene) {
    const std::string ending = lower_case_extension(scene);
    if (ending != ".glb" && ending != ".gltf")
        return Error{"the page reads .glb and .gltf", scene.string(), "Export the scene as glTF."};
    if (auto ok = check_readable(scene); !ok) return ok.error();
    const std::string address = "/files/scene/" + scene.filename().generic_string();
    files_[address] = {scene, media_type(scene)};
    if (ending == ".glb") return address;

    const auto gltf = Json::read(scene);
    if (!gltf) return gltf.error();
    const fs::path folder = scene.has_parent_path() ? scene.parent_path() : fs::path(".");
    for (const std::string& uri : uris_of(*gltf)) {
        if (is_data_uri(uri)) continue;
        const auto place = path_of_uri(uri, folder);
        std::error_code code;
        if (!place || !fs::is_regular_file(*place, code)) continue;  // the page says that it is missing
        const fs::path inside = place->lexically_relative(fs::canonical(folder, code));
        files_["/files/scene/" + inside.generic_string()] = {*place, media_type(*place)};
    }
    return address;
}

Result<std::string> ServedFiles::add_environment(const fs::path& file, int number) {
    if (auto ok = check_readable(file); !ok) return ok.error();
    const std::string address = fmt::format("/files/environment/{}/{}", number, file.filename().generic_string());
    files_[address] = {file, media_type(file)};
    return address;
}

Result<std::vector<std::string>> ServedFiles::add_probes(const fs::path& folder) {
    const auto record = read_probe_record(folder);
    if (!record) return record.error();
    std::vector<std::string> addresses;
    for (const std::string& name : files_of(*record)) {
        const auto place = path_inside(folder / name, folder, name);
        if (!place) return place.error().at((folder / k_probes_json).string());
        if (auto ok = check_readable(*place); !ok) return ok.error();
        addresses.push_back("/files/probes/" + name);
        files_[addresses.back()] = {*place, media_type(*place)};
    }
    return addresses;
}

const ServedFiles::File* ServedFiles::find(const std::string& address) const {
    const auto found = files_.find(address);
    return found == files_.end() ? nullptr : &found->second;
}

}  // namespace domelight
