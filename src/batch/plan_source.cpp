#include "batch/plan_source.h"

#include "domelight/io/file/file_extension.h"

#include "batch/job_kind.h"
#include "batch/plan_file.h"
#include "io/environment/cube_face_names.h"
#include "io/environment/environment_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>

namespace domelight {
namespace {

namespace fs = std::filesystem;

/// The options that every job has, from the words of the caller.
Json common_options(const BatchPlanOptions& options) {
    Json json = Json::object();
    for (const auto& [name, word] : options.options) {
        const auto value = Json::parse(word);
        json[name] = value ? *value : Json(word);
    }
    return json;
}

// --- a folder ---

bool is_environment_ending(const std::string& ending) {
    return ending == ".hdr" || ending == ".exr";
}

/// Collects the environments below a folder.
class FolderSearch {
  public:
    FolderSearch(fs::path root, std::string kind, Json options)
        : root_(std::move(root)), kind_(std::move(kind)), options_(std::move(options)) {}

    Result<PlanSource> run() {
        if (auto ok = search(root_); !ok) return ok.error();
        PlanSource source{root_, std::move(entries_), {}};
        if (!left_out_.empty()) {
            std::string list;
            for (const auto& [ending, count] : left_out_)
                list +=
                    fmt::format("{}{} ({})", list.empty() ? "" : ", ", ending.empty() ? "no ending" : ending, count);
            source.warnings.push_back("files of other endings than .hdr and .exr were left out: " + list +
                                      "; a manifest can name them");
        }
        return source;
    }

  private:
    Result<void> search(const fs::path& folder) {
        std::error_code failure;
        std::vector<fs::directory_entry> found;
        for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure))
            found.push_back(*at);
        if (failure) return Error{"cannot be read: " + failure.message(), folder.string(), ""};
        std::sort(found.begin(), found.end());
        // Six faces in a folder of their own are one environment.
        const auto faces = cube_faces_in_folder(folder);
        if (faces.size() == 6 && folder != root_) add(folder.lexically_relative(root_).string(), faces);
        for (const fs::directory_entry& entry : found) {
            const fs::path& path = entry.path();
            if (path.filename().string().starts_with('.')) continue;
            if (entry.is_directory(failure)) {
                if (fs::exists(path / k_plan_file, failure)) continue;  // an earlier batch
                if (auto ok = search(path); !ok) return ok;
            } else if (faces.size() != 6 || std::find(faces.begin(), faces.end(), path) == faces.end()) {
                const std::string ending = lower_case_extension(path);
                if (is_environment_ending(ending))
                    add(fs::path(path).replace_extension().lexically_relative(root_).string(), {path});
                else
                    ++left_out_[ending];
            }
        }
        return {};
    }

    void add(const std::string& output, const std::vector<fs::path>& files) {
        PlanEntry entry{files.front().lexically_relative(root_).string(), kind_, output, {}, options_};
        for (const fs::path& file : files)
            entry.inputs.push_back({"environment", file.lexically_relative(root_).string(), "", 0});
        entries_.push_back(std::move(entry));
    }

    fs::path root_;
    std::string kind_;
    Json options_;
    std::vector<PlanEntry> entries_;
    std::map<std::string, int> left_out_;
};

// --- a manifest ---

/// The role's name without the mark that it may be missing.
std::string role_name(std::string role) {
    if (role.ends_with('?')) role.pop_back();
    return role;
}

Result<void> read_role(const Json& json, const std::string& role, const fs::path& root, PlanEntry& entry) {
    const std::string key = role_name(role);
    const Json* value = json.find(key);
    if (!value) {
        if (role.ends_with('?')) return {};
        return Error{fmt::format("has no \"{}\", which a job of kind {} reads", key, entry.kind), entry.place, ""};
    }
    std::vector<fs::path> files;
    const auto take = [&](const Json& file) {
        if (file.is_string() && !file.get<std::string>().empty()) files.emplace_back(file.get<std::string>());
    };
    take(*value);
    for (const Json& file : value->elements()) take(file);
    if (files.size() != std::max<std::size_t>(1, value->size()))
        return Error{fmt::format("\"{}\" is not a file's name or an array of them", key), entry.place, ""};
    // A folder of six faces becomes its files, which can be hashed.
    if (const auto faces = environment_files({root / files[0]}); files.size() == 1 && faces.size() == 6) {
        const bool absolute = files[0].is_absolute();
        files.clear();
        for (const fs::path& face : faces) files.push_back(absolute ? face : face.lexically_relative(root));
    }
    for (const fs::path& file : files) entry.inputs.push_back({key, file.generic_string(), "", 0});
    return {};
}

Result<std::string> text_of(const Json& json, const char* key, const std::string& place) {
    const Json* value = json.find(key);
    if (!value) return Error{fmt::format("has no \"{}\"", key), place, "Each job needs one of its own."};
    if (!value->is_string() || value->get<std::string>().empty())
        return Error{fmt::format("\"{}\" is not a text", key), place, ""};
    return value->get<std::string>();
}

/// Names that lead out of the folder, or that no file can have.
Result<void> check_output(const std::string& output, const std::string& place) {
    const fs::path path(output);
    bool good = path.is_relative() && path.has_filename() && output.find('\0') == output.npos;
    for (const fs::path& part : path) good &= part != "." && part != ".." && part.string().size() < 200;
    if (good) return {};
    return Error{fmt::format("the output \"{}\" does not lie in the batch's folder", output), place,
                 "Write a relative path without \"..\", as in \"indoor/studio\"."};
}

class ManifestReader {
  public:
    ManifestReader(fs::path root, std::string kind, Json options)
        : source_{std::move(root), {}, {}}, kind_(std::move(kind)), options_(std::move(options)) {}

    Result<void> set_defaults(const Json& defaults, const std::string& place) {
        for (const auto& [key, value] : defaults.items()) {
            if (key == "kind" && value.is_string())
                kind_ = value.get<std::string>();
            else if (key == "options" && value.is_object())
                options_.update(value);
            else
                return Error{fmt::format("\"{}\" is not known in the defaults, or of a wrong type", key), place,
                             "Accepted: kind, options."};
        }
        return {};
    }

    Result<void> add(const Json& json, const std::string& place) {
        if (!json.is_object()) return Error{"is not a JSON object", place, ""};
        PlanEntry entry{place, kind_, "", {}, options_};
        if (json.contains("kind")) {
            const auto kind = text_of(json, "kind", place);
            if (!kind) return kind.error();
            entry.kind = *kind;
        }
        const auto kind = find_job_kind(entry.kind);
        if (!kind) return kind.error().at(place);
        if (auto ok = check_keys(json, **kind, place); !ok) return ok;
        auto output = text_of(json, "output", place);
        if (!output) return output.error();
        entry.output = *std::move(output);
        for (const std::string& role : (*kind)->roles)
            if (auto ok = read_role(json, role, source_.root, entry); !ok) return ok;
        if (const Json* own = json.find("options")) {
            if (!own->is_object()) return Error{"\"options\" is not an object", place, ""};
            entry.options.update(*own);
        }
        source_.entries.push_back(std::move(entry));
        return {};
    }

    PlanSource take() { return std::move(source_); }

  private:
    static Result<void> check_keys(const Json& json, const JobKind& kind, const std::string& place) {
        std::vector<std::string> accepted{"kind", "output", "options"};
        for (const std::string& role : kind.roles) accepted.push_back(role_name(role));
        for (const auto& [key, value] : json.items())
            if (std::find(accepted.begin(), accepted.end(), key) == accepted.end())
                return Error{fmt::format("\"{}\" is not a key of a job of kind {}", key, kind.name), place,
                             fmt::format("Accepted: {}.", fmt::join(accepted, ", "))};
        return {};
    }

    PlanSource source_;
    std::string kind_;
    Json options_;
};

Result<void> read_lines(const fs::path& file, ManifestReader& reader) {
    std::ifstream in(file);
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        if (line.find_first_not_of(" \t\r") == line.npos) continue;
        const std::string place = fmt::format("{} line {}", file.filename().string(), number);
        const auto json = Json::parse(line);
        if (!json) return json.error().at(place);
        if (auto ok = reader.add(*json, place); !ok) return ok;
    }
    if (!in.eof()) return Error{"cannot be read", file.string(), ""};
    return {};
}

Result<void> read_document(const fs::path& file, ManifestReader& reader) {
    const auto json = Json::read(file);
    if (!json) return json.error();
    const std::string name = file.filename().string();
    for (const auto& [key, value] : json->items())
        if (key != "defaults" && key != "jobs")
            return Error{fmt::format("\"{}\" is not a key of a manifest", key), name, "Accepted: defaults, jobs."};
    if (!json->is_object() || !(*json)["jobs"].is_array())
        return Error{"has no array \"jobs\"", name, "A manifest is {\"defaults\": {...}, \"jobs\": [{...}]}."};
    if (const Json* defaults = json->find("defaults"))
        if (auto ok = reader.set_defaults(*defaults, name + " defaults"); !ok) return ok;
    std::size_t index = 0;
    for (const Json& job : (*json)["jobs"].elements())
        if (auto ok = reader.add(job, fmt::format("{} jobs[{}]", name, index++)); !ok) return ok;
    return {};
}

}  // namespace

Result<PlanSource> read_plan_source(const fs::path& source, const BatchPlanOptions& options) {
    std::error_code failure;
    const fs::file_status status = fs::status(source, failure);
    if (!fs::exists(status)) return Error{"there is no such file or folder", source.string(), ""};
    const fs::path absolute = fs::absolute(source, failure).lexically_normal();
    Result<PlanSource> made = PlanSource();
    if (fs::is_directory(status)) {
        const fs::path root = absolute.has_filename() ? absolute : absolute.parent_path();
        made = FolderSearch(root, options.kind, common_options(options)).run();
    } else {
        ManifestReader reader(absolute.parent_path(), options.kind, common_options(options));
        const bool lines = lower_case_extension(source) == ".jsonl";
        if (auto ok = lines ? read_lines(source, reader) : read_document(source, reader); !ok) return ok.error();
        made = reader.take();
    }
    if (!made) return made;
    if (made->entries.empty())
        return Error{"there is no job in it", source.string(),
                     "A folder needs .hdr or .exr files, a manifest an object for each job."};
    for (const PlanEntry& entry : made->entries)
        if (auto ok = check_output(entry.output, entry.place); !ok) return ok.error();
    return made;
}

}  // namespace domelight
