#include "batch/run_log.h"

#include "batch/json_values.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <vector>

namespace domelight {
namespace {

namespace fs = std::filesystem;

void read_line(const std::string& line, std::map<std::string, LoggedJob>& jobs) {
    const auto json = Json::parse(line);
    if (!json || text_in(*json, "job").empty()) return;
    LoggedJob& job = jobs[text_in(*json, "job")];
    const bool done = text_in(*json, "status") == "done";
    ++job.attempts;
    if (!done) job.reason = text_in(*json, "reason");
    if (job.done && !done) return;
    job.done = done;
    job.host = text_in(*json, "host");
    job.threads = int(number_in(*json, "threads"));
    job.seconds = number_in(*json, "seconds");
    job.cpu_seconds = number_in(*json, "cpu_seconds");
    job.peak_bytes = std::int64_t(number_in(*json, "peak_bytes"));
}

}  // namespace

RunLog::RunLog(fs::path batch, BatchShard shard)
    : file_(std::move(batch) / "log" / fmt::format("{}-{}.jsonl", host_name(), ::getpid())),
      shard_(fmt::format("{}/{}", shard.index, shard.count)),
      host_(host_name()) {
    std::error_code ignored;
    fs::create_directories(file_.parent_path(), ignored);
}

void RunLog::add(const BatchJob& job, const WorkerAnswer& answer, int attempt, int threads) {
    const Json json{{"job", job.id},
                    {"output", job.output},
                    {"status", answer.done      ? "done"
                               : answer.changed ? "changed"
                                                : "failed"},
                    {"reason", answer.reason},
                    {"attempt", attempt},
                    {"threads", threads},
                    {"seconds", answer.seconds},
                    {"cpu_seconds", answer.cpu_seconds},
                    {"peak_bytes", answer.peak_bytes},
                    {"host", host_},
                    {"shard", shard_},
                    {"ended", std::int64_t(std::time(nullptr))}};
    const std::string line = json.dump() + "\n";
    const int descriptor = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor < 0) return;
    [[maybe_unused]] const ssize_t written = ::write(descriptor, line.data(), line.size());
    ::close(descriptor);
}

std::map<std::string, LoggedJob> read_logs(const fs::path& batch) {
    std::vector<fs::path> files;
    std::error_code failure;
    for (fs::directory_iterator at(batch / "log", failure), end; !failure && at != end; at.increment(failure))
        if (at->path().extension() == ".jsonl") files.push_back(at->path());
    std::sort(files.begin(), files.end());
    std::map<std::string, LoggedJob> jobs;
    for (const fs::path& file : files) {
        std::ifstream in(file);
        for (std::string line; std::getline(in, line);) read_line(line, jobs);
    }
    return jobs;
}

}  // namespace domelight
