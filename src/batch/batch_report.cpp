#include "domelight/base/parallel.h"
#include "domelight/batch/batch_results.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"

#include "batch/report_page.h"
#include "batch/result_store.h"
#include "batch/run_log.h"
#include "batch/thumbnail.h"
#include "io/file/output_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

namespace domelight {
namespace {

namespace fs = std::filesystem;

constexpr int k_thumbnail_width = 640;

/// A path as a link of the page, with what a URL gives a meaning to escaped.
std::string link_of(const fs::path& path) {
    std::string link;
    for (const char c : path.generic_string())
        if (std::isalnum(static_cast<unsigned char>(c)) || std::string_view("/-_.~").find(c) != std::string_view::npos)
            link += c;
        else
            link += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    return link;
}

/// Whether a browser shows the file.
bool is_shown(const fs::path& file) {
    return is_screen_picture(file);
}

/// What is to be seen of a job.
struct Shown {
    std::optional<ResultRecord> record;
    bool thumb = false;
};

Json job_json(const BatchJob& job, const Shown& shown, const std::map<std::string, LoggedJob>& logs,
              const ResultStore& store, const fs::path& page) {
    const auto log = logs.find(job.id);
    Json json{{"output", job.output}, {"kind", job.kind}, {"estimate", job.seconds}};
    json["status"] = shown.record ? "done" : log != logs.end() ? "failed" : "missing";
    json["warnings"] = Json::array();
    if (log != logs.end()) {
        const LoggedJob& l = log->second;
        json.update({{"attempts", l.attempts}, {"host", l.host}, {"seconds", l.seconds}, {"cpu", l.cpu_seconds}});
        json["memory"] = l.peak_bytes > 0 ? Json(l.peak_bytes) : Json();
        json["reason"] = l.reason;
    }
    if (!shown.record) return json;
    const ResultRecord& record = *shown.record;
    std::int64_t bytes = 0;
    for (const ResultFile& file : record.files) bytes += file.bytes;
    json["bytes"] = bytes;
    json["repaired"] = record.report.repaired;
    json["error"] = record.report.error < 0 ? Json() : Json(record.report.error);
    json["error_of"] = record.report.error_of;
    json["warnings"] = Json(record.report.warnings);
    json["folder"] = link_of((store.files(job.id) / "").lexically_relative(page));
    if (!shown.thumb) return json;
    json["thumb"] = link_of(fs::path("thumbs") / (job.id + ".jpg"));
    const fs::path preview = store.files(job.id) / record.report.preview;
    if (is_shown(preview)) json["picture"] = link_of(preview.lexically_relative(page));
    return json;
}

/// JSON that no parser of HTML takes for the end of the script.
std::string inside_script(std::string text) {
    std::string out;
    for (const char c : text) out += c == '<' ? std::string("\\u003c") : std::string(1, c);
    return out;
}

/// The small picture of a result; one of an earlier report is kept.
bool draw(const ResultRecord& record, const ResultStore& store, const fs::path& file) {
    std::error_code failure;
    if (record.report.preview.empty()) return false;
    if (fs::exists(file, failure)) return true;
    const auto image = thumbnail(store.files(record.job) / record.report.preview, k_thumbnail_width, 1);
    return image && write_jpeg(file, image->view(), 80);
}

}  // namespace

Result<fs::path> write_batch_report(const BatchPlan& plan, const fs::path& folder, int threads,
                                    const Progress& progress) {
    std::error_code failure;
    const fs::path batch = fs::absolute(folder, failure).lexically_normal(), page = batch / "report";
    if (auto ok = check_output_folder(page); !ok) return ok.error();
    fs::create_directories(page / "thumbs", failure);
    if (failure) return Error{"cannot be created: " + failure.message(), page.string(), ""};
    const ResultStore store(batch);
    const auto logs = read_logs(batch);
    std::vector<Shown> shown(plan.jobs.size());
    constexpr std::size_t block = 64;  // jobs between two calls of `progress`
    for (std::size_t begin = 0; begin < shown.size(); begin += block) {
        const std::size_t count = std::min(block, shown.size() - begin);
        parallel_for(int(count), threads, [&](int i) {
            const BatchJob& job = plan.jobs[begin + std::size_t(i)];
            Shown& it = shown[begin + std::size_t(i)];
            it.record = store.find(job.id);
            it.thumb = it.record && draw(*it.record, store, page / "thumbs" / (job.id + ".jpg"));
        });
        if (progress && !progress("draw", double(begin + count) / double(shown.size())))
            return Error{"cancelled", "", ""};
    }
    const fs::path name = batch.has_filename() ? batch.filename() : batch.parent_path().filename();
    Json document{{"title", name.string()}, {"version", plan.version}, {"root", plan.root.string()}};
    Json& jobs = document["jobs"] = Json::array();
    for (std::size_t i = 0; i < shown.size(); ++i) jobs.push_back(job_json(plan.jobs[i], shown[i], logs, store, page));
    const std::string text = k_report_head + inside_script(document.dump()) + k_report_tail;
    const fs::path file = page / "index.html";
    if (auto ok = write_file_atomically(file, text); !ok) return ok.error();
    return file;
}

}  // namespace domelight
