#pragma once

#include "domelight/batch/batch_plan.h"
#include "domelight/batch/batch_results.h"
#include "domelight/batch/batch_run.h"

#include "cli/console/arguments.h"
#include "cli/console/console.h"

#include <optional>
#include <string>
#include <vector>

namespace domelight::cli {

/// The command line of `batch`.
struct BatchWords {
    CommonOptions common;
    std::vector<std::string> words;  ///< the action, and what it is done to
    std::string output, kind = "bake";
    std::vector<std::string> engines, settings;
    std::string shard, memory;
    std::optional<int> shards, workers, attempts, cpus;
    std::vector<std::string> sbatch;
    bool check = false, help_others = false, no_submit = false;
    BatchPlacing placing = BatchPlacing::link;

    const std::string& action() const { return words.front(); }
    /// The folder of the plan.
    const std::string& plan() const { return words.back(); }
};

/// One action each. They return the exit code.
int batch_plan(const BatchWords& words);
int batch_run(const BatchWords& words);
int batch_merge(const BatchWords& words);
int batch_verify(const BatchWords& words);
int batch_report(const BatchWords& words);
int batch_slurm(const BatchWords& words);

}  // namespace domelight::cli
