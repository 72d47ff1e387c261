#pragma once

#include "domelight/batch/batch_plan.h"

#include "batch/result_store.h"

#include <sys/types.h>

#include <cstddef>
#include <memory>
#include <string>

namespace domelight {

/// What a worker says of a job, or what is known of it after the worker has ended.
struct WorkerAnswer {
    bool done = false, changed = false;
    std::string reason;  ///< of a job that was not done
    bool ended = false;  ///< the worker itself ended: it crashed or was killed
    double seconds = 0, cpu_seconds = 0;
    std::int64_t peak_bytes = 0;  ///< of the worker's memory, up to the end of this job
};

/// A process forked from this one that does one job after the other. What goes wrong in it, a crash or a lack of memory,
/// ends it and nothing else. It ends with its parent.
class Worker {
  public:
    /// Errors: the system starts no more processes.
    static Result<std::unique_ptr<Worker>> start(const BatchPlan& plan, const ResultStore& store);
    /// Ends the process, with the files it was writing, if it is still there.
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Gives it a job. Precondition: it has none.
    void give(std::size_t job, int threads);
    /// Readable when it has an answer, or has ended.
    int descriptor() const { return answers_; }
    /// The answer, which is waited for.
    WorkerAnswer answer();
    pid_t process() const { return process_; }

  private:
    Worker(pid_t process, int questions, int answers) : process_(process), questions_(questions), answers_(answers) {}
    pid_t process_;
    int questions_, answers_;
    std::string received_;
};

}  // namespace domelight
