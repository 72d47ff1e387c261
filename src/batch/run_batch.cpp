#include "domelight/base/parallel.h"
#include "domelight/base/version.h"
#include "domelight/batch/batch_run.h"

#include "base/field_place.h"
#include "batch/claims.h"
#include "batch/job_run.h"
#include "batch/memory_budget.h"
#include "batch/plan_file.h"
#include "batch/result_store.h"
#include "batch/run_log.h"
#include "batch/worker.h"
#include "io/file/output_place.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <optional>
#include <unordered_map>

namespace domelight {
namespace {

namespace fs = std::filesystem;

/// Writing to a worker that has just ended is an error to look at, not the end of the program.
class NoBrokenPipes {
  public:
    NoBrokenPipes() {
        struct sigaction ignore = {};
        ignore.sa_handler = SIG_IGN;
        ::sigaction(SIGPIPE, &ignore, &before_);
    }
    ~NoBrokenPipes() { ::sigaction(SIGPIPE, &before_, nullptr); }
    NoBrokenPipes(const NoBrokenPipes&) = delete;
    NoBrokenPipes& operator=(const NoBrokenPipes&) = delete;

  private:
    struct sigaction before_;
};

bool is_disk_full(const fs::path& folder, const std::string& reason) {
    for (const int code : {ENOSPC, EDQUOT})
        if (reason.find(std::strerror(code)) != reason.npos) return true;
    struct statvfs disk = {};
    return ::statvfs(folder.c_str(), &disk) == 0 && disk.f_blocks > 0 && disk.f_bavail == 0;
}

Result<void> check_options(const BatchPlan& plan, const BatchRunOptions& o) {
    if (o.shard.count < 1 || o.shard.index < 1 || o.shard.index > o.shard.count)
        return Error{fmt::format("{}/{} is not a shard", o.shard.index, o.shard.count), field_place("shard"),
                     "I/N: shard I of N, counted from 1."};
    const auto at_least = [](const char* field, std::int64_t value, std::int64_t least) -> Result<void> {
        if (value >= least) return {};
        return Error{fmt::format("{} is less than {}", value, least), field_place(field), ""};
    };
    for (const auto& ok : {at_least("threads", o.threads, 0), at_least("workers", o.workers, 0),
                           at_least("memory", o.memory, 0), at_least("attempts", o.attempts, 1)})
        if (!ok) return ok;
    if (plan.version != version())
        return Error{fmt::format("the plan was made by version {}, this is {}", plan.version, version()), "",
                     "Plan again."};
    return {};
}

/// The jobs of one run and what becomes of them.
class BatchRun {
  public:
    BatchRun(const BatchPlan& plan, const fs::path& folder, const BatchRunOptions& options, Claims claims)
        : plan_(plan),
          folder_(folder),
          options_(options),
          claims_(std::move(claims)),
          store_(folder),
          log_(folder, options.shard),
          threads_(resolve_threads(options.threads)),
          most_workers_(options.workers > 0 ? options.workers : threads_),
          memory_(options.memory > 0 ? options.memory : available_memory() / 4 * 3) {}

    BatchRunReport run() {
        list_jobs();
        while (!is_finished() && !interrupted()) {
            start_jobs();
            if (!running_.empty())
                take_answers();
            else if (!elsewhere_.empty())
                look_elsewhere();
        }
        stop();
        for (std::size_t i = own_; i < report_.outcomes.size(); ++i)
            report_.helped += report_.outcomes[i].status == BatchStatus::done;
        report_.outcomes.resize(own_);
        report_.seconds = seconds();
        return std::move(report_);
    }

  private:
    struct Running {
        std::unique_ptr<Worker> worker;
        std::size_t outcome;
        int threads;
    };

    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    const BatchJob& job(std::size_t outcome) const { return plan_.jobs[report_.outcomes[outcome].job]; }

    // Sorts the shard's jobs into those that are done and those to do. The longest come first.
    void list_jobs() {
        const auto shards = plan_shards(plan_, options_.shard.count);
        const auto& shard = shards[std::size_t(options_.shard.index - 1)];
        if (options_.help_others) list_others(shards);
        std::vector<std::size_t> in_order = shard;
        std::sort(in_order.begin(), in_order.end());
        std::unordered_map<std::size_t, std::size_t> outcome_of;
        for (const std::size_t index : in_order) {
            outcome_of[index] = report_.outcomes.size();
            report_.outcomes.emplace_back().job = index;
        }
        own_ = report_.outcomes.size();
        for (const std::size_t index : shard) {
            const std::size_t outcome = outcome_of[index];
            if (!take_kept(outcome)) pending_.push_back(outcome);
        }
    }

    // The jobs of the other shards, from the ends of their lists: each shard begins with its longest. The next shard
    // comes first, so that several helpers do not all look at the same one.
    void list_others(const std::vector<std::vector<std::size_t>>& shards) {
        std::size_t longest = 0;
        for (const auto& shard : shards) longest = std::max(longest, shard.size());
        for (std::size_t from_end = 1; from_end <= longest; ++from_end)
            for (std::size_t s = 1; s < shards.size(); ++s) {
                const auto& other = shards[(std::size_t(options_.shard.index) - 1 + s) % shards.size()];
                if (from_end <= other.size()) others_.push_back(other[other.size() - from_end]);
            }
    }

    // Whether there may be something to do for other shards, and time for it.
    bool helps() const { return next_other_ < others_.size() && (own_seconds_ < 0 || seconds() < 2 * own_seconds_); }

    // The next job of another shard that nobody has done or is doing.
    std::optional<std::size_t> next_of_others() {
        if (own_seconds_ < 0) own_seconds_ = seconds();
        for (; helps(); ++next_other_) {
            const BatchJob& other = plan_.jobs[others_[next_other_]];
            if (other.memory > memory_ - memory_in_use() && !running_.empty()) return std::nullopt;
            if (store_.find(other.id) || !claims_.take(other.id)) continue;
            claims_.release(other.id);  // start() takes it
            report_.outcomes.emplace_back().job = others_[next_other_++];
            return report_.outcomes.size() - 1;
        }
        return std::nullopt;
    }

    // A result that is there: counted as kept, or as changed where its source has changed since.
    bool take_kept(std::size_t outcome) {
        const BatchJob& it = job(outcome);
        const auto record = store_.find(it.id);
        if (!record || (options_.check && !store_.verify(*record))) return false;
        const std::string what = changed_input(plan_, it, store_.finished_at(it.id));
        end(outcome, what.empty() ? BatchStatus::kept : BatchStatus::changed, what);
        return true;
    }

    void end(std::size_t outcome, BatchStatus status, std::string reason) {
        BatchOutcome& o = report_.outcomes[outcome];
        o.status = status;
        o.reason = std::move(reason);
        if (outcome >= own_ && own_ > 0) return;  // of another shard
        ++finished_;
        if (options_.progress) options_.progress(o, finished_, report_.outcomes.size());
    }

    bool is_finished() const {
        const bool nothing_left = pending_.empty() && suspects_.empty() && elsewhere_.empty() && !helps();
        return running_.empty() && (nothing_left || !report_.stopped_by.empty());
    }

    bool interrupted() {
        report_.cancelled = options_.interrupted && options_.interrupted();
        return report_.cancelled;
    }

    std::int64_t memory_in_use() const {
        std::int64_t bytes = 0;
        for (const Running& r : running_) bytes += job(r.outcome).memory;
        return bytes;
    }

    int threads_in_use() const {
        int threads = 0;
        for (const Running& r : running_) threads += r.threads;
        return threads;
    }

    // Gives jobs to workers while there are workers and memory.
    void start_jobs() {
        while (report_.stopped_by.empty() && int(running_.size()) < most_workers_ && !alone_) {
            const auto next = next_job();
            if (!next) break;
            start(*next);
        }
        while (report_.stopped_by.empty() && int(running_.size()) < most_workers_ && !alone_ && pending_.empty() &&
               suspects_.empty()) {
            const auto next = next_of_others();
            if (!next) break;
            start(*next);
        }
        // A job at which a worker ended is tried again with no other job beside it.
        if (report_.stopped_by.empty() && running_.empty() && pending_.empty() && !suspects_.empty()) {
            const std::size_t suspect = suspects_.front();
            suspects_.pop_front();
            alone_ = true;
            start(suspect);
        }
    }

    // The first job that fits into the memory that is left, or any if nothing is running.
    std::optional<std::size_t> next_job() {
        const std::int64_t left = memory_ - memory_in_use();
        for (auto at = pending_.begin(); at != pending_.end(); ++at)
            if (running_.empty() || job(*at).memory <= left) {
                const std::size_t outcome = *at;
                pending_.erase(at);
                return outcome;
            }
        return std::nullopt;
    }

    // How many threads a job gets: its share of those that are idle, given how many jobs can be started beside it.
    int share_of_threads(std::size_t outcome) const {
        if (alone_) return threads_;
        const std::int64_t left = memory_ - memory_in_use(), need = std::max<std::int64_t>(1, job(outcome).memory);
        const std::int64_t beside =
            std::min<std::int64_t>({std::int64_t(pending_.size()) + 1, most_workers_ - std::int64_t(running_.size()),
                                    std::max<std::int64_t>(1, left / need)});
        return std::max(1, (threads_ - threads_in_use()) / int(beside));
    }

    void start(std::size_t outcome) {
        const BatchJob& it = job(outcome);
        if (!claims_.take(it.id)) {
            alone_ = false;
            if (outcome < own_) elsewhere_.push_back(outcome);
            return;
        }
        // Another run may have finished it between our look and our claim.
        if (take_kept(outcome)) {
            alone_ = false;
            claims_.release(it.id);
            return;
        }
        std::unique_ptr<Worker> worker;
        if (!idle_.empty()) {
            worker = std::move(idle_.back());
            idle_.pop_back();
        } else {
            auto started = Worker::start(plan_, store_);
            if (!started) {
                claims_.release(it.id);
                pending_.push_front(outcome);
                if (running_.empty()) report_.stopped_by = one_line(started.error());
                most_workers_ = std::max(1, int(running_.size()));
                return;
            }
            worker = *std::move(started);
        }
        const int threads = share_of_threads(outcome);
        worker->give(report_.outcomes[outcome].job, threads);
        running_.push_back({std::move(worker), outcome, threads});
    }

    // Waits for an answer, at most a fifth of a second, and takes those that there are.
    void take_answers() {
        std::vector<pollfd> watched;
        for (const Running& r : running_) watched.push_back({r.worker->descriptor(), POLLIN, 0});
        if (::poll(watched.data(), nfds_t(watched.size()), 200) <= 0) return;
        for (std::size_t i = watched.size(); i-- > 0;)
            if (watched[i].revents != 0) {
                Running r = std::move(running_[i]);
                running_.erase(running_.begin() + std::ptrdiff_t(i));
                take_answer(std::move(r));
            }
    }

    void take_answer(Running r) {
        const WorkerAnswer answer = r.worker->answer();
        BatchOutcome& o = report_.outcomes[r.outcome];
        const BatchJob& it = job(r.outcome);
        ++o.attempts;
        o.seconds = answer.seconds;
        log_.add(it, answer, o.attempts, r.threads);
        if (answer.ended)
            store_.remove_leftovers(false);
        else
            idle_.push_back(std::move(r.worker));
        claims_.release(it.id);
        alone_ = false;
        if (answer.done) return end(r.outcome, BatchStatus::done, "");
        if (answer.changed) return end(r.outcome, BatchStatus::changed, answer.reason);
        if (is_disk_full(folder_, answer.reason)) {
            report_.stopped_by = "the disk is full";
            return end(r.outcome, BatchStatus::failed, answer.reason);
        }
        if (r.outcome >= own_) return end(r.outcome, BatchStatus::failed, answer.reason);  // its own shard tries again
        if (o.attempts >= options_.attempts) return end(r.outcome, BatchStatus::failed, answer.reason);
        (answer.ended ? suspects_ : pending_).push_back(r.outcome);
    }

    // Jobs that another run claims: done by now, given up, or still under way.
    void look_elsewhere() {
        std::deque<std::size_t> still;
        for (const std::size_t outcome : elsewhere_) {
            if (take_kept(outcome)) continue;
            if (claims_.take(job(outcome).id)) {
                claims_.release(job(outcome).id);
                pending_.push_back(outcome);
            } else {
                still.push_back(outcome);
            }
        }
        elsewhere_ = std::move(still);
        if (pending_.empty() && !elsewhere_.empty()) ::poll(nullptr, 0, 200);
    }

    void stop() {
        for (const Running& r : running_) claims_.release(job(r.outcome).id);
        running_.clear();
        idle_.clear();
        store_.remove_leftovers(false);
        std::error_code ignored;
        fs::remove(folder_ / "work", ignored);  // only if it is empty
    }

    const BatchPlan& plan_;
    const fs::path& folder_;
    const BatchRunOptions& options_;
    Claims claims_;
    ResultStore store_;
    RunLog log_;
    int threads_, most_workers_;
    std::int64_t memory_;

    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();

    BatchRunReport report_;  ///< while running, with outcomes of other shards' jobs behind the own ones
    std::size_t own_ = 0;    ///< outcomes of this shard
    std::size_t finished_ = 0;
    std::vector<std::size_t> others_;  ///< jobs of other shards to help with; indices of the plan
    std::size_t next_other_ = 0;
    double own_seconds_ = -1;            ///< how long the own jobs took; -1: they are not done yet
    std::deque<std::size_t> pending_;    ///< to do, the longest first; indices of outcomes, as below
    std::deque<std::size_t> suspects_;   ///< at which a worker ended
    std::deque<std::size_t> elsewhere_;  ///< another run is doing them
    bool alone_ = false;                 ///< the job under way is to have no other beside it
    std::vector<Running> running_;
    std::vector<std::unique_ptr<Worker>> idle_;
};

Result<Claims> open_batch(const BatchPlan& plan, const fs::path& folder, const BatchRunOptions& options) {
    if (auto ok = check_options(plan, options); !ok) return ok.error();
    std::error_code failure;
    for (const char* name : {"results", "log"}) fs::create_directories(folder / name, failure);
    if (auto ok = check_output_folder(folder); !ok) return ok.error();
    auto claims = Claims::open(folder / "locks");
    if (claims) ResultStore(folder).remove_leftovers(false);
    return claims;
}

}  // namespace

std::size_t BatchRunReport::count(BatchStatus status) const {
    return std::size_t(std::count_if(outcomes.begin(), outcomes.end(),
                                     [&](const BatchOutcome& outcome) { return outcome.status == status; }));
}

Result<BatchRunReport> run_batch(const BatchPlan& plan, const fs::path& folder, const BatchRunOptions& options) {
    auto claims = open_batch(plan, folder, options);
    if (!claims) return claims.error();
    const NoBrokenPipes no_broken_pipes;
    return BatchRun(plan, folder, options, *std::move(claims)).run();
}

Result<BatchOutcome> run_batch_job(const BatchPlan& plan, const fs::path& folder, std::size_t index, int threads) {
    if (index >= plan.jobs.size())
        return Error{fmt::format("{} is not a job of a plan of {}", index, plan.jobs.size()), field_place("job"), ""};
    auto claims = open_batch(plan, folder, {});
    if (!claims) return claims.error();
    const BatchJob& job = plan.jobs[index];
    const ResultStore store(folder);
    BatchOutcome outcome;
    outcome.job = index;
    outcome.status = BatchStatus::kept;
    if (!claims->take(job.id))
        return Error{"another run is doing the job", job.output, "Its result will be there when that run has ended."};
    if (store.find(job.id)) {
        const std::string what = changed_input(plan, job, store.finished_at(job.id));
        if (!what.empty()) return Error{what, job.output, "Plan again."};
        return outcome;
    }
    const auto start = std::chrono::steady_clock::now();
    WorkerAnswer answer;
    const auto ok = do_job(plan, job, store, threads, answer.changed);
    answer.done = bool(ok);
    answer.reason = ok ? "" : one_line(ok.error());
    answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    RunLog(folder, {}).add(job, answer, 1, threads);
    if (!ok) return ok.error().at(job.output);
    outcome.status = BatchStatus::done;
    outcome.attempts = 1;
    outcome.seconds = answer.seconds;
    return outcome;
}

}  // namespace domelight
