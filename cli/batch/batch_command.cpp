#include "domelight/engines/engine.h"

#include "cli/batch/batch_words.h"
#include "cli/commands.h"
#include "cli/console/output_endings.h"
#include "cli/console/suggestion.h"

#include <fmt/core.h>

#include <algorithm>

namespace domelight::cli {
namespace {

struct Action {
    const char* name;
    const char* takes;  ///< what stands after it
    const char* does;
    int (*run)(const BatchWords&);
    std::vector<const char*> options;  ///< those that it takes, besides the common ones
};

const std::vector<Action>& actions() {
    static const std::vector<Action> table{
        {"plan",
         "MANIFEST|FOLDER",
         "lists every job with its hashed inputs, options, output and cost",
         batch_plan,
         {"--output", "--for", "--kind", "--set", "--shards"}},
        {"run",
         "PLAN",
         "does the jobs that are not done yet, or those of a shard",
         batch_run,
         {"--shard", "--shards", "--workers", "--memory", "--attempts", "--check", "--help-others"}},
        {"merge",
         "PLAN",
         "puts the results under the names of the outputs, in PLAN/out; fails if any is missing",
         batch_merge,
         {"--place"}},
        {"verify", "PLAN", "hashes every file of every result", batch_verify, {}},
        {"report",
         "PLAN",
         "writes PLAN/report/index.html: a picture, times, size, errors and repairs of each job",
         batch_report,
         {}},
        {"slurm",
         "PLAN",
         "submits an array of shards to Slurm, and a job that merges them",
         batch_slurm,
         {"--shards", "--cpus", "--sbatch", "--no-submit"}},
    };
    return table;
}

/// "plan MANIFEST|FOLDER: lists ...; run PLAN: does ...".
std::string list_of_actions() {
    std::string list;
    for (const Action& action : actions())
        list += fmt::format("{}{} {}: {}", list.empty() ? "" : "; ", action.name, action.takes, action.does);
    return list;
}

std::vector<std::string> kind_names() {
    std::vector<std::string> names;
    for (const BatchKind& kind : batch_kinds()) names.push_back(kind.name);
    return names;
}

std::vector<std::string> engine_names() {
    std::vector<std::string> names;
    for (const Engine& engine : engines()) names.push_back(engine.name);
    return names;
}

void declare(Arguments& a, BatchWords& w) {
    a.positional("ACTION PLAN", w.words, list_of_actions());
    a.group("Planning");
    a.text("-o,--output", "PLAN", w.output, "plan: the folder for the plan, and later for the results");
    a.choices("--for", w.engines, engine_names(),
              "plan: the engines to bake for, as in bake; may be given several times");
    a.choice("--kind", w.kind, kind_names(), "plan: what is done to each environment of a folder (bake)");
    a.texts("--set", "NAME=VALUE", w.settings,
            "plan: an option of every job, as in the command of that name, with _ for -: size=128, encoding=rgb9e5, "
            "roughness=[0,0.5,1]; may be given several times");
    a.group("Sharing the work");
    a.text(
        "--shard", "I/N", w.shard,
        "run: the jobs of shard I of N, 1 to N, which are about equal in cost; with --shards N alone, I is read from "
        "SLURM_ARRAY_TASK_ID, AWS_BATCH_JOB_ARRAY_INDEX or JOB_COMPLETION_INDEX (all jobs)");
    a.integer(
        "--shards", "N", w.shards,
        "plan: lines of commands.txt (16); run: the N of --shard; slurm: members of the array (16); 1 to 1000000");
    a.flag("--help-others", w.help_others,
           "run: after the jobs of the shard, do jobs of other shards that nobody does yet, for as long again");
    a.group("Running");
    a.integer("--workers", "N", w.workers,
              "run: processes that do jobs side by side, 1 to 1024; --threads is for all of them together (as many as "
              "threads)");
    a.text(
        "--memory", "BYTES", w.memory,
        "run: what the jobs under way may need together by their estimates: 8G, 500M (three quarters of what is free)");
    a.integer("--attempts", "N", w.attempts, "run: how often a job that fails is tried, 1 to 100 (2)");
    a.flag("--check", w.check, "run: hash the results that are there, and do again what is not as it was written");
    a.group("Slurm");
    a.integer("--cpus", "N", w.cpus, "slurm: cores of each shard, 1 to 1024 (1)");
    a.texts(
        "--sbatch", "OPTION", w.sbatch,
        "slurm: an option for sbatch, as in --sbatch=--partition=long; it overrides what is estimated; may be given "
        "several times");
    a.flag("--no-submit", w.no_submit, "slurm: write PLAN/slurm/array.sh and merge.sh, and submit nothing");
    a.group("Results");
    a.choice("--place", w.placing, "merge: relative links, further names of the same files, or copies (link)");
    add_common_options(a, w.common);
}

/// The action that the words name.
Result<const Action*> find_action(const BatchWords& w) {
    std::vector<std::string> names;
    for (const Action& action : actions()) names.emplace_back(action.name);
    if (w.words.empty()) return Error{"needs an action", "batch", "Accepted: " + join(names, ", ") + "."};
    for (const Action& action : actions())
        if (w.action() == action.name) {
            if (w.words.size() == 2) return &action;
            return Error{fmt::format("takes one {}, not {} words", action.takes, w.words.size() - 1),
                         fmt::format("batch {}", action.name),
                         fmt::format("As in: domelight batch {} {}", action.name, action.takes)};
        }
    return Error{fmt::format("unknown action {}", w.action()), "batch",
                 did_you_mean(w.action(), names) + "Accepted: " + join(names, ", ") + "."};
}

void warn_of_idle(const Arguments& arguments, const Action& action, const CommonOptions& common) {
    std::vector<OptionRule> rules;
    for (const Action& other : actions())
        for (const char* option : other.options)
            if (std::ranges::find(action.options, std::string_view(option)) == action.options.end())
                rules.push_back({option, false, other.name});
    warn_of_idle_options(arguments, rules, common);
}

}  // namespace

int run_batch(const std::vector<std::string>& words) {
    BatchWords w;
    Arguments arguments("batch",
                        "Does any number of jobs (bakes and other commands) from a plan: resumable, on one machine or "
                        "on many, with the "
                        "same bytes. A plan is a folder with plan.jsonl, which lists the jobs, and commands.txt, which "
                        "has a command for "
                        "each shard.",
                        {"domelight batch plan hdris --for three --for babylon -o lights", "domelight batch run lights",
                         "domelight batch run lights --shard 2/3"});
    declare(arguments, w);
    if (const auto code = begin_command(arguments, words, w.common)) return *code;
    const auto action = find_action(w);
    if (!action) return print_error(action.error(), exit_usage);
    warn_of_idle(arguments, **action, w.common);
    return (*action)->run(w);
}

}  // namespace domelight::cli
