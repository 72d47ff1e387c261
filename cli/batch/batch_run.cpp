#include "domelight/base/version.h"

#include "cli/batch/batch_words.h"
#include "cli/console/field_options.h"
#include "cli/console/interruption.h"
#include "cli/console/print.h"
#include "io/file/json.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdlib>

namespace domelight::cli {
namespace {

/// Where schedulers say which member of an array this process is.
struct ArrayVariable {
    const char* index;
    int first;          ///< the index of the first member
    const char* count;  ///< the variable that holds how many there are, or null
};
constexpr ArrayVariable k_arrays[] = {
    {"SLURM_ARRAY_TASK_ID", 1, nullptr},  // Slurm's count is less where a part is run again
    {"AWS_BATCH_JOB_ARRAY_INDEX", 0, "AWS_BATCH_JOB_ARRAY_SIZE"},
    {"JOB_COMPLETION_INDEX", 0, nullptr},
};

std::optional<int> number_in(const char* variable) {
    const char* text = variable ? std::getenv(variable) : nullptr;
    if (!text) return std::nullopt;
    const auto number = parse_integer(text);
    return number ? std::optional(*number) : std::nullopt;
}

/// The shard by the scheduler's variables.
Result<BatchShard> shard_of_scheduler(const std::optional<int>& shards) {
    for (const ArrayVariable& array : k_arrays) {
        const auto index = number_in(array.index);
        if (!index) continue;
        const auto count = shards ? shards : number_in(array.count);
        if (!count)
            return Error{fmt::format("{} is {}, but of how many shards is not known", array.index, *index), "--shards",
                         "Say it: --shards N, or --shard I/N."};
        if (*index < array.first || *index - array.first >= *count)
            return Error{
                fmt::format("{} is {}, which is not one of {} shards", array.index, *index, *count), "--shards",
                fmt::format("The array must have the indices {} to {}.", array.first, *count - 1 + array.first)};
        return BatchShard{*index - array.first + 1, *count};
    }
    if (!shards) return BatchShard{};
    return Error{"says how many shards there are, but not which one this is", "--shards",
                 "Give --shard I/N, or run in an array of Slurm, AWS Batch or Kubernetes."};
}

Result<BatchShard> shard_of(const BatchWords& w) {
    if (w.shard.empty()) return shard_of_scheduler(w.shards);
    const auto parts = split(w.shard, '/');
    const auto index = parse_integer(parts[0]), count = parse_integer(parts.size() == 2 ? parts[1] : "");
    if (!index || !count || *count < 1 || *index < 1 || *index > *count)
        return Error{fmt::format("\"{}\" is not a shard", w.shard), "--shard",
                     "Write I/N: shard I of N, 1 to N, as in 2/7."};
    return BatchShard{*index, *count};
}

/// "8G", "500M" or a number of bytes.
Result<std::int64_t> parse_bytes(const std::string& text) {
    if (text.empty()) return std::int64_t(0);
    constexpr std::string_view units = "KMGT";
    const std::size_t unit = units.find(text.back());
    const auto number = parse_number(unit == units.npos ? text : text.substr(0, text.size() - 1));
    const double bytes = number ? *number * std::ldexp(1.0, unit == units.npos ? 0 : 10 * (int(unit) + 1)) : 0;
    if (!(bytes >= 1 && bytes < 1e18))
        return Error{fmt::format("\"{}\" is not a number of bytes", text), "--memory", "As in 8G, 500M or 1000000000."};
    return std::int64_t(bytes);
}

Result<BatchRunOptions> run_options(const BatchWords& w) {
    const struct {
        const char* option;
        std::optional<int> value;
        double most;
    } ranges[] = {{"--workers", w.workers, 1024}, {"--attempts", w.attempts, 100}, {"--shards", w.shards, 1e6}};
    for (const auto& range : ranges)
        if (range.value)
            if (auto ok = within(range.option, *range.value, 1, range.most); !ok) return ok.error();
    const auto shard = shard_of(w);
    if (!shard) return shard.error();
    const auto memory = parse_bytes(w.memory);
    if (!memory) return memory.error();
    BatchRunOptions options;
    options.shard = *shard;
    options.threads = w.common.threads.value_or(0);
    options.workers = w.workers.value_or(0);
    options.attempts = w.attempts.value_or(options.attempts);
    options.memory = *memory;
    options.check = w.check;
    options.help_others = w.help_others;
    return options;
}

Json outcome_json(const BatchPlan& plan, const BatchOutcome& o) {
    const BatchJob& job = plan.jobs[o.job];
    return {{"job", job.id},
            {"output", job.output},
            {"status", name_of(o.status)},
            {"reason", o.reason.empty() ? Json() : Json(with_options(o.reason))},
            {"attempts", o.attempts},
            {"seconds", o.seconds}};
}

void print_json(const BatchPlan& plan, const BatchRunReport& report, const BatchShard& shard) {
    Json jobs = Json::array(), counts = Json::object();
    for (const BatchOutcome& o : report.outcomes) jobs.push_back(outcome_json(plan, o));
    for (const auto& row : EnumNames<BatchStatus>::table) counts[row.name] = report.count(row.value);
    print_document(Json{{"version", version()},
                        {"shard", fmt::format("{}/{}", shard.index, shard.count)},
                        {"complete", report.complete()},
                        {"stopped_by", report.stopped_by.empty() ? Json() : Json(report.stopped_by)},
                        {"helped", report.helped},
                        {"seconds", report.seconds},
                        {"counts", counts},
                        {"jobs", jobs}});
}

void print_text(const BatchPlan& plan, const BatchRunReport& report) {
    for (const BatchOutcome& o : report.outcomes)
        if (o.status == BatchStatus::failed || o.status == BatchStatus::changed)
            print("{}: {}: {}\n", plan.jobs[o.job].output, name_of(o.status), with_options(o.reason));
    print("{} of {} jobs done", report.count(BatchStatus::done) + report.count(BatchStatus::kept),
          report.outcomes.size());
    for (const auto& [status, words] : {std::pair{BatchStatus::kept, "before"},
                                        {BatchStatus::failed, "failed"},
                                        {BatchStatus::changed, "with changed sources"},
                                        {BatchStatus::left, "not tried"}})
        if (const std::size_t n = report.count(status)) print(", {} {}", n, words);
    if (report.helped) print(", and {} of other shards", report.helped);
    print("; {:.2f} s\n", report.seconds);
}

}  // namespace

int batch_run(const BatchWords& w) {
    auto options = run_options(w);
    if (!options) return print_error(options.error(), exit_usage);
    const auto plan = read_plan(w.plan());
    if (!plan) return print_error(plan.error());
    Interruption interruption;
    Result<BatchRunReport> report = Error{"", "", ""};
    {
        ProgressBar bar(w.plan(), w.common);
        options->progress = [&](const BatchOutcome&, std::size_t finished, std::size_t of) {
            bar.update(fmt::format("{} of {} jobs", finished, of), double(finished) / double(of));
        };
        options->interrupted = [] { return Interruption::wanted(); };
        report = domelight::run_batch(*plan, w.plan(), *options);
    }
    if (!report) return print_error(report.error());
    if (report->cancelled)
        return interruption.end(fmt::format("{} of {} jobs are done; the same command does the others",
                                            report->count(BatchStatus::done) + report->count(BatchStatus::kept),
                                            report->outcomes.size()));
    if (!report->stopped_by.empty()) print_error({"stopped: " + report->stopped_by, w.plan(), ""});
    if (w.common.json)
        print_json(*plan, *report, options->shard);
    else if (!w.common.quiet || !report->complete())
        print_text(*plan, *report);
    if (!report->complete()) return exit_failed;
    if (options->shard.count > 1) return exit_done;
    // The whole set is there.
    const auto merge = merge_batch(*plan, w.plan());
    if (!merge) return print_error(merge.error());
    print_warnings(merge->notes, w.common);
    return exit_done;
}

}  // namespace domelight::cli
