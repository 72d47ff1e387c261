#include "domelight/base/version.h"
#include "domelight/io/file/atomic_file.h"

#include "cli/batch/batch_words.h"
#include "cli/batch/shell_word.h"
#include "cli/console/field_options.h"
#include "cli/console/output_endings.h"
#include "cli/console/print.h"
#include "io/file/json.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace domelight::cli {
namespace {

Result<BatchPlanOptions> plan_options(const BatchWords& w) {
    BatchPlanOptions options;
    options.kind = w.kind;
    options.threads = w.common.threads.value_or(0);
    if (!w.engines.empty()) options.options.emplace_back("for", Json(w.engines).dump());
    for (const std::string& setting : w.settings) {
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos || equals == 0)
            return Error{fmt::format("\"{}\" is not NAME=VALUE", setting), "--set", "As in: --set size=128"};
        options.options.emplace_back(setting.substr(0, equals), setting.substr(equals + 1));
    }
    return options;
}

/// commands.txt: a line for each shard, for schedulers that take command lines.
Result<void> write_commands(const std::filesystem::path& folder, int shards) {
    std::error_code failure;
    const std::string place = shell_word(std::filesystem::weakly_canonical(folder, failure).string());
    std::string text;
    for (int i = 1; i <= shards; ++i) text += fmt::format("domelight batch run {} --shard {}/{}\n", place, i, shards);
    return write_file_atomically(folder / "commands.txt", text);
}

void print_result(const BatchWords& w, const BatchPlan& plan, int shards) {
    double seconds = 0;
    std::int64_t memory = 0;
    for (const BatchJob& job : plan.jobs) {
        seconds += job.seconds;
        memory = std::max(memory, job.memory);
    }
    if (w.common.json) {
        print_document(Json{{"version", version()},
                            {"plan", w.output},
                            {"jobs", plan.jobs.size()},
                            {"shards", shards},
                            {"estimated_cpu_seconds", seconds},
                            {"estimated_memory", memory},
                            {"warnings", Json(plan.warnings)}});
    } else if (!w.common.quiet) {
        print("{}: {} jobs, about {} of one core, {} MB for the largest\n", w.output, plan.jobs.size(),
              clock_text(std::ceil(seconds)), memory >> 20);
        print("  {:<28} the jobs\n  {:<28} {} commands, one for each shard\n", "plan.jsonl", "commands.txt", shards);
        print("run them with: domelight batch run {}\n", w.output);
    }
}

}  // namespace

int batch_plan(const BatchWords& w) {
    if (w.output.empty())
        return print_error({"is missing", "--output", "Say where the plan goes: -o PLAN."}, exit_usage);
    if (auto ok = check_folder("--output", w.output); !ok) return print_error(ok.error(), exit_usage);
    const int asked = w.shards.value_or(16);
    if (auto ok = within("--shards", asked, 1, 1e6); !ok) return print_error(ok.error(), exit_usage);
    auto options = plan_options(w);
    if (!options) return print_error(options.error(), exit_usage);
    ProgressBar bar(w.words.back(), w.common);
    options->progress = bar.callback();
    const auto plan = plan_batch(w.words.back(), *options);
    if (!plan) return print_error(with_options(plan.error()));
    const int shards = int(std::min(std::size_t(asked), plan->jobs.size()));
    if (auto ok = write_plan(*plan, w.output); !ok) return print_error(ok.error());
    if (auto ok = write_commands(w.output, shards); !ok) return print_error(ok.error());
    print_warnings(with_options(plan->warnings), w.common, w.words.back());
    print_result(w, *plan, shards);
    return exit_done;
}

}  // namespace domelight::cli
