#include "batch/job_run.h"

#include "io/file/sha256.h"

#include <fmt/format.h>

#include <new>

namespace domelight {
namespace {

namespace fs = std::filesystem;

Result<JobCall> call_of(const BatchPlan& plan, const BatchJob& job, const fs::path& folder, int threads) {
    const auto options = Json::parse(job.options);
    if (!options) return options.error();
    JobCall call{{}, *options, fs::path(job.output).filename().string(), folder, threads};
    for (const BatchInput& input : job.inputs) call.inputs[input.role].push_back(plan.root / input.file);
    return call;
}

/// The job itself, with a lack of memory as an error like others.
Result<JobReport> run_kind(const JobKind& kind, const JobCall& call) {
    try {
        return kind.run(call);
    } catch (const std::bad_alloc&) {
        return Error{"not enough memory", "", "Give the jobs fewer workers, or more memory."};
    } catch (const std::exception& e) {
        return Error{e.what(), "", ""};
    }
}

}  // namespace

std::string one_line(const Error& error) {
    const std::string text = error.where.empty() ? error.what : error.where + ": " + error.what;
    return error.hint.empty() ? text : text + ". " + error.hint;
}

std::string changed_input(const BatchPlan& plan, const BatchJob& job, std::optional<fs::file_time_type> since) {
    for (const BatchInput& input : job.inputs) {
        const fs::path file = plan.root / input.file;
        std::error_code failure;
        const auto bytes = fs::file_size(file, failure);
        if (failure) return fmt::format("{}: {}, but the plan reads it", file.string(), failure.message());
        const auto changed = [&] { return fmt::format("{}: it has changed since the plan was made", file.string()); };
        if (std::int64_t(bytes) != input.bytes) return changed();
        if (since && fs::last_write_time(file, failure) <= *since) continue;
        const auto hash = sha256_file(file);
        if (!hash) return one_line(hash.error());
        if (*hash != input.sha256) return changed();
    }
    return {};
}

Result<void> do_job(const BatchPlan& plan, const BatchJob& job, const ResultStore& store, int threads, bool& changed) {
    const auto kind = find_job_kind(job.kind);
    if (!kind) return kind.error();
    const std::string hint = "Plan again: the results of other jobs are kept.";
    const auto begun = fs::file_time_type::clock::now();
    if (const std::string what = changed_input(plan, job); !what.empty()) {
        changed = true;
        return Error{what, "", hint};
    }
    store.remove(job.id);  // what is there is not intact, or this job would not be done
    const auto folder = store.begin(job.id);
    if (!folder) return folder.error();
    const auto fail = [&](const Error& error) {
        store.abandon(job.id);
        return error;
    };
    const auto call = call_of(plan, job, *folder, threads);
    if (!call) return fail(call.error());
    const auto report = run_kind(**kind, *call);
    if (!report) return fail(report.error());
    // A source that was written to while it was read.
    if (const std::string what = changed_input(plan, job, begun); !what.empty()) {
        changed = true;
        return fail({what, "", hint});
    }
    if (auto ok = store.finish(job, *report); !ok) return fail(ok.error());
    return {};
}

}  // namespace domelight
