#include "batch/result_store.h"

#include "domelight/io/file/atomic_file.h"

#include "batch/json_values.h"
#include "io/file/path_inside.h"
#include "io/file/sha256.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>

namespace domelight {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_record_file = "done.json";

Json report_json(const JobReport& report) {
    return {{"warnings", Json(report.warnings)},
            {"repaired", report.repaired},
            {"error", report.error < 0 ? Json() : Json(report.error)},
            {"error_of", report.error_of},
            {"preview", report.preview}};
}

std::string record_text(const ResultRecord& record) {
    Json files = Json::array();
    for (const ResultFile& file : record.files)
        files.push_back({{"file", file.name}, {"bytes", file.bytes}, {"sha256", file.sha256}});
    return Json{{"job", record.job}, {"kind", record.kind}, {"files", files}, {"report", report_json(record.report)}}
               .dump(1) +
           "\n";
}

std::optional<ResultRecord> record_of(const Json& json, const std::string& job) {
    ResultRecord record{text_in(json, "job"), text_in(json, "kind"), {}, {}};
    if (record.job != job) return std::nullopt;
    for (const Json& file : json["files"].elements())
        record.files.push_back(
            {text_in(file, "file"), std::int64_t(number_in(file, "bytes", -1)), text_in(file, "sha256")});
    const Json& report = json["report"];
    for (const Json& warning : report["warnings"].elements())
        if (warning.is_string()) record.report.warnings.push_back(warning.get<std::string>());
    record.report.repaired = std::int64_t(number_in(report, "repaired", 0));
    record.report.error = number_in(report, "error", -1);
    record.report.error_of = text_in(report, "error_of");
    record.report.preview = text_in(report, "preview");
    return record;
}

/// Every file below `folder`, sorted by name. Those that `known` has no hash of are hashed.
Result<std::vector<ResultFile>> take_stock(const fs::path& folder, const std::map<std::string, std::string>& known) {
    std::vector<ResultFile> files;
    std::error_code failure;
    for (fs::recursive_directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure)) {
        if (at->is_directory(failure)) continue;
        ResultFile file{at->path().lexically_relative(folder).generic_string(), std::int64_t(at->file_size(failure)),
                        ""};
        if (const auto hash = known.find(file.name); hash != known.end()) {
            file.sha256 = hash->second;
        } else {
            const auto made = sha256_file(at->path());
            if (!made) return made.error();
            file.sha256 = *made;
        }
        files.push_back(std::move(file));
    }
    if (failure) return Error{"cannot be read: " + failure.message(), folder.string(), ""};
    std::sort(files.begin(), files.end(), [](const ResultFile& a, const ResultFile& b) { return a.name < b.name; });
    return files;
}

/// The process of an unfinished result: its folder is called JOB-HOST-PID.
bool is_alive(const std::string& name, const std::string& host) {
    const std::size_t dash = name.rfind('-');
    const std::size_t first = name.find('-');
    if (dash == name.npos || first == dash) return false;
    if (name.substr(first + 1, dash - first - 1) != host) return true;  // of another machine: not known
    int process = 0;
    std::from_chars(name.data() + dash + 1, name.data() + name.size(), process);
    return process > 0 && (::kill(process, 0) == 0 || errno == EPERM);
}

}  // namespace

std::string host_name() {
    char name[256] = "machine";
    ::gethostname(name, sizeof name - 1);
    std::string text = name;
    for (char& c : text)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '_') c = '_';
    return text;
}

fs::path ResultStore::work(const std::string& job) const {
    return batch_ / "work" / fmt::format("{}-{}-{}", job, host_name(), ::getpid());
}

std::optional<ResultRecord> ResultStore::find(const std::string& job) const {
    const auto json = Json::read(folder(job) / k_record_file);
    if (!json) return std::nullopt;
    auto record = record_of(*json, job);
    if (!record) return std::nullopt;
    for (const ResultFile& file : record->files) {
        std::error_code failure;
        const auto bytes = fs::file_size(files(job) / file.name, failure);
        if (failure || std::int64_t(bytes) != file.bytes) return std::nullopt;
    }
    return record;
}

std::optional<fs::file_time_type> ResultStore::finished_at(const std::string& job) const {
    std::error_code failure;
    const auto time = fs::last_write_time(folder(job) / k_record_file, failure);
    return failure ? std::nullopt : std::optional(time);
}

Result<void> ResultStore::verify(const ResultRecord& record) const {
    for (const ResultFile& file : record.files) {
        const auto hash = sha256_in_folder(files(record.job), file.name);
        if (!hash) return hash.error();
        if (*hash != file.sha256)
            return Error{"its contents are not those that were written", (files(record.job) / file.name).string(), ""};
    }
    return {};
}

Result<fs::path> ResultStore::begin(const std::string& job) const {
    const fs::path folder = work(job) / "files";
    std::error_code failure;
    fs::remove_all(work(job), failure);
    fs::create_directories(folder, failure);
    if (failure) return Error{"cannot be created: " + failure.message(), folder.string(), ""};
    return folder;
}

Result<void> ResultStore::finish(const BatchJob& job, const JobReport& report) const {
    const fs::path from = work(job.id), to = folder(job.id);
    auto files = take_stock(from / "files", report.hashes);
    if (!files) return files.error();
    const std::string text = record_text({job.id, job.kind, *std::move(files), report});
    if (auto ok = write_file_atomically(from / k_record_file, text); !ok) return ok;
    std::error_code failure;
    fs::create_directories(to.parent_path(), failure);
    if (failure) return Error{"cannot be created: " + failure.message(), to.parent_path().string(), ""};
    fs::rename(from, to, failure);
    if (failure && find(job.id)) {  // another run was first
        abandon(job.id);
        return {};
    }
    if (failure) return Error{"cannot be moved to its place: " + failure.message(), to.string(), ""};
    return {};
}

void ResultStore::remove(const std::string& job) const {
    std::error_code ignored;
    fs::remove_all(folder(job), ignored);
}

void ResultStore::abandon(const std::string& job) const {
    std::error_code ignored;
    fs::remove_all(work(job), ignored);
}

int ResultStore::remove_leftovers(bool all) const {
    int removed = 0;
    std::error_code failure;
    std::vector<fs::path> found;
    for (fs::directory_iterator at(batch_ / "work", failure), end; !failure && at != end; at.increment(failure))
        found.push_back(at->path());
    const std::string host = host_name();
    for (const fs::path& path : found)
        if (all || !is_alive(path.filename().string(), host)) {
            std::error_code ignored;
            removed += fs::remove_all(path, ignored) > 0;
        }
    if (all) fs::remove(batch_ / "work", failure);
    return removed;
}

}  // namespace domelight
