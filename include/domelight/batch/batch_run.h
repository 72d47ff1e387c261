#pragma once
// Runs a planned batch, or a shard of it: on this machine, resumable, beside other runs of the same plan.

#include "domelight/base/names.h"
#include "domelight/base/result.h"
#include "domelight/batch/batch_plan.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace domelight {

/// A part of the plan: shard `index` of `count`, counted from 1.
struct BatchShard {
    int index = 1, count = 1;
};

/// What became of a job.
enum class BatchStatus {
    done,     ///< in this run
    kept,     ///< done before, and intact
    failed,   ///< with an error, after every attempt
    changed,  ///< not run, or kept: an input is no longer what was planned
    left      ///< not tried, because the run was stopped
};
template <>
struct EnumNames<BatchStatus> {
    static constexpr const char* kind = "a status";
    static constexpr NamedValue<BatchStatus> table[] = {
        {BatchStatus::done, "done"},       {BatchStatus::kept, "kept"}, {BatchStatus::failed, "failed"},
        {BatchStatus::changed, "changed"}, {BatchStatus::left, "left"},
    };
};

struct BatchOutcome {
    std::size_t job = 0;  ///< index in the plan
    BatchStatus status = BatchStatus::left;
    std::string reason;  ///< of `failed` and `changed`: the last attempt's error
    int attempts = 0;
    double seconds = 0;  ///< wall-clock time of the last attempt
};

struct BatchRunOptions {
    BatchShard shard;
    int threads = 0;  ///< of all jobs together; 0: all cores
    int workers = 0;  ///< processes that do jobs side by side; 0: as many as threads
    /// Bytes that the jobs under way may need together by their estimates; 0: three quarters of what is free. A job that
    /// needs more by itself runs alone.
    std::int64_t memory = 0;
    int attempts = 2;  ///< of each job, >= 1
    /// After the jobs of its shard, does jobs of other shards that nobody does yet, the shortest first, for as long as its
    /// own took: shards whose cost was estimated too high then help those whose cost was estimated too low.
    bool help_others = false;
    /// Hashes what is there before it counts as done, and does again what is not as it was written: after a power cut.
    /// Otherwise the sizes of the files are looked at.
    bool check = false;
    /// Called after each job of the shard, also for those that were done before.
    std::function<void(const BatchOutcome& outcome, std::size_t finished, std::size_t of)> progress;
    /// Asked several times a second: true ends the jobs under way and stops the run.
    std::function<bool()> interrupted;
};

struct BatchRunReport {
    std::vector<BatchOutcome> outcomes;  ///< of each job of the shard, in the order of the plan
    std::size_t helped = 0;              ///< jobs of other shards that were done
    double seconds = 0;
    bool cancelled = false;
    std::string stopped_by;  ///< why no further jobs were started ("the disk is full"); empty: all were tried
    std::size_t count(BatchStatus status) const;
    bool complete() const { return count(BatchStatus::done) + count(BatchStatus::kept) == outcomes.size(); }
};

/// Runs the jobs of a shard that are not done yet. Each job runs in a process of its own making, a worker that is forked
/// from this one, so that a job that crashes or is killed for its memory ends alone; it is then tried again by itself.
///
/// A result is written to a folder beside its place and moved to results/ID in one step, with done.json, which names and
/// hashes every file. A run that is killed at any moment therefore leaves whole results and no others; what it has left
/// of unfinished ones is removed by the next run. A power cut can lose files of the last seconds: BatchRunOptions::check
/// finds that.
///
/// Several runs of one plan at once, on one machine or several, share the work: a job that another run is doing (which
/// holds a lock on a byte of `folder`/locks) is left to it and waited for.
///
/// Preconditions: no other thread of this program is running (the workers are forked).
/// Errors, before any job is run: a shard that is out of range; options out of range; a plan of another version;
/// `folder` cannot be written to. Jobs that fail are not errors: the report tells of them.
Result<BatchRunReport> run_batch(const BatchPlan& plan, const std::filesystem::path& folder,
                                 const BatchRunOptions& options = {});

/// Runs one job in this process, for schedulers that have workers of their own. Nothing is done where the result is there
/// and intact.
///
/// threads   0: all
/// Errors: those of the job; an input that is no longer what was planned; another run is doing the job.
Result<BatchOutcome> run_batch_job(const BatchPlan& plan, const std::filesystem::path& folder, std::size_t job,
                                   int threads = 0);

}  // namespace domelight
