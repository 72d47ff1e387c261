#include "domelight/batch/batch_results.h"

#include "domelight/base/version.h"

#include "cli/batch/batch_words.h"
#include "cli/console/print.h"
#include "io/file/json.h"

#include <fmt/core.h>

#include <algorithm>

namespace domelight::cli {
namespace {

Json problems_json(const std::vector<BatchProblem>& problems) {
    Json list = Json::array();
    for (const BatchProblem& problem : problems) list.push_back({{"output", problem.output}, {"what", problem.what}});
    return list;
}

/// The first of them on stdout, and how many more there are.
void print_problems(const std::vector<BatchProblem>& problems) {
    constexpr std::size_t most = 20;
    for (std::size_t i = 0; i < std::min(most, problems.size()); ++i)
        print("{}: {}\n", problems[i].output, problems[i].what);
    if (problems.size() > most) print("and {} more; --json lists them all\n", problems.size() - most);
}

}  // namespace

int batch_merge(const BatchWords& w) {
    const auto plan = read_plan(w.plan());
    if (!plan) return print_error(plan.error());
    ProgressBar bar(w.plan(), w.common);
    const auto merge = merge_batch(*plan, w.plan(), w.placing, bar.callback());
    if (!merge) return print_error(merge.error());
    print_warnings(merge->notes, w.common);
    if (w.common.json) {
        print_document(Json{{"version", version()},
                            {"complete", merge->complete()},
                            {"placed", merge->placed},
                            {"kept", merge->kept},
                            {"missing", problems_json(merge->missing)},
                            {"notes", Json(merge->notes)}});
    } else if (!w.common.quiet || !merge->complete()) {
        print_problems(merge->missing);
        print("{}/out: {} of {} outputs{}\n", w.plan(), merge->placed + merge->kept, plan->jobs.size(),
              merge->complete() ? ", listed in index.jsonl" : fmt::format("; {} are missing", merge->missing.size()));
    }
    return merge->complete() ? exit_done : exit_failed;
}

int batch_verify(const BatchWords& w) {
    const auto plan = read_plan(w.plan());
    if (!plan) return print_error(plan.error());
    ProgressBar bar(w.plan(), w.common);
    const auto found = verify_batch(*plan, w.plan(), w.common.threads.value_or(0), bar.callback());
    if (!found) return print_error(found.error());
    if (w.common.json) {
        print_document(Json{{"version", version()},
                            {"intact", found->problems.empty()},
                            {"jobs", found->jobs},
                            {"files", found->files},
                            {"bytes", found->bytes},
                            {"problems", problems_json(found->problems)}});
    } else if (!w.common.quiet || !found->problems.empty()) {
        print_problems(found->problems);
        print("{} jobs, {} files, {:.1f} MB: {}\n", found->jobs, found->files, 1e-6 * double(found->bytes),
              found->problems.empty() ? "all intact" : fmt::format("{} problems", found->problems.size()));
    }
    return found->problems.empty() ? exit_done : exit_failed;
}

int batch_report(const BatchWords& w) {
    const auto plan = read_plan(w.plan());
    if (!plan) return print_error(plan.error());
    ProgressBar bar(w.plan(), w.common);
    const auto file = write_batch_report(*plan, w.plan(), w.common.threads.value_or(0), bar.callback());
    if (!file) return print_error(file.error());
    if (w.common.json)
        print_document(Json{{"version", version()}, {"file", file->string()}});
    else if (!w.common.quiet)
        print("{}: a page with each of {} jobs\n", file->string(), plan->jobs.size());
    return exit_done;
}

}  // namespace domelight::cli
