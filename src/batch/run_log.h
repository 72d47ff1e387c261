#pragma once

#include "domelight/base/result.h"
#include "domelight/batch/batch_plan.h"
#include "domelight/batch/batch_run.h"

#include "batch/worker.h"

#include <filesystem>
#include <map>
#include <string>

namespace domelight {

/// log/HOST-PID.jsonl: a line for each attempt at a job, with what depends on time and machine. Nothing is read from it
/// but reports; a line that was cut off is passed over.
class RunLog {
  public:
    RunLog(std::filesystem::path batch, BatchShard shard);
    /// Failures to write are ignored: the results do not depend on it.
    void add(const BatchJob& job, const WorkerAnswer& answer, int attempt, int threads);

  private:
    std::filesystem::path file_;
    std::string shard_, host_;
};

/// What the logs of a batch say of a job.
struct LoggedJob {
    bool done = false;
    std::string reason;  ///< of the last attempt that failed
    std::string host;
    int attempts = 0, threads = 0;
    double seconds = 0, cpu_seconds = 0;  ///< of the attempt that succeeded, or of the last one
    std::int64_t peak_bytes = 0;
};
/// By the jobs' ids.
std::map<std::string, LoggedJob> read_logs(const std::filesystem::path& batch);

}  // namespace domelight
